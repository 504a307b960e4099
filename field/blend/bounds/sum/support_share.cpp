#include "field/blend/bounds/sum/support_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "field/math/elementary.h"
#include "field/number/functions.h"
#include "field/skeleton/corners.h"
#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/reach.h"
#include "field/skeleton/seen_line.h"

namespace marrow {
namespace {

// Of 1 - (R slope)^2: below that rounding may decide.
constexpr double least_open = 1e-7;

// By which distances may differ from the middle.
double slack_of(const auto& s, double rho) { return rho * (1 + 1e-9) + 1e-9 * least_radius(s); }

}  // namespace

double share_within(const PointSkeleton&, double) { return 1; }
double share_within(const SegmentSkeleton& s, double reach) {
  return std::min(length(s.to - s.from), 2 * reach) / least_radius(s);
}
// A ball that holds less than half of a circle holds an arc whose chord is no longer than its diameter.
double share_within(const ArcSkeleton& s, double reach) {
  const double most = reach < s.major ? 2 * s.major * asin(reach / s.major) * (1 + 1e-12) : measure(s);
  return std::min(measure(s), most) / least_radius(s);
}
double share_within(const TriangleSkeleton& s, double reach) {
  return std::min(measure(s), std::numbers::pi * reach * reach) / square(least_radius(s)) * (1 + 1e-12);
}

double share_crossing(const PointSkeleton& s, const Vec3d& p, double rho, double R, bool) {
  return std::fabs(length(p - s.at) - R * s.radius) <= rho * (1 + 1e-9) + 1e-12 * s.radius ? 1 : 0;
}

// d = R radius + by is where the support reaches with radii that are by / R larger.
double share_crossing(const SegmentSkeleton& s, const Vec3d& p, double rho, double R, bool anywhere) {
  const SeenLine seen = seen_from(s, p);
  if (!(1 - square(R * seen.line.slope) > least_open)) return seen.length / least_radius(s);
  const auto chord = [&](double by) {
    Line line = seen.line;
    line.at_foot += by / R;
    const Reach<double> reach = reach_along(line, R);
    if (reach.is_empty) return 0.0;
    const auto place = [&](double t) { return anywhere ? t : std::clamp(t, line.t1, line.t2); };
    return place(*reach.to) - place(*reach.from);
  };
  const double slack = slack_of(s, rho);
  return std::max(0.0, chord(slack) - chord(-slack)) / least_radius(s);
}

// Parts of the arc are out where they are too far from the edge for their length; others are halved, as long as they
// are few and longer than what is asked for.
double share_crossing(const ArcSkeleton& s, const Vec3d& p, double rho, double R, bool) {
  constexpr std::size_t most_parts = 32;
  const double slack = slack_of(s, rho), slope = (s.radius_to - s.radius_from) / (s.end - s.begin);
  const double steep = s.major + R * std::fabs(slope);  // of what is left to the edge, by the angle
  std::array<double, 2 * most_parts> begins{s.begin};
  std::size_t count = 1;
  double width = s.end - s.begin;
  for (;;) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double middle = begins[i] + 0.5 * width;
      const double beyond = length(p - place_at(s, middle)) - R * (s.radius_from + slope * (middle - s.begin));
      if (std::fabs(beyond) <= slack + 0.5 * width * steep * (1 + 1e-9)) begins[left++] = begins[i];
    }
    count = left;
    if (count == 0 || count > most_parts / 2 || s.major * width < 0.5 * slack) break;
    width *= 0.5;
    for (std::size_t i = count; i-- > 0;) {
      begins[2 * i + 1] = begins[i] + width;
      begins[2 * i] = begins[i];
    }
    count *= 2;
  }
  return static_cast<double>(count) * s.major * width / least_radius(s) * (1 + 1e-9);
}

// In its plane d = R tau + by is an ellipse of the area pi q / sqrt(1 - k^2), q = c^2 / (1 - k^2) - h^2, k = R times
// the slope of the radius and c = R radius_f + by.
double share_crossing(const TriangleSkeleton& s, const Vec3d& p, double rho, double R, bool) {
  const Corners corners(s);
  const Vec3d rise = corners.gradient_of(s.radii);
  const Vec3d from_corner = p - s.vertices[0];
  const double open = 1 - R * R * length_squared(rise), slack = slack_of(s, rho);
  const double h2 = square(dot(from_corner, corners.normal)) / corners.area2;
  const double whole = measure(s) / square(least_radius(s));
  if (!(open > least_open)) return whole;
  const auto area = [&](double by) {
    const double c = R * (s.radii[0] + dot(from_corner, rise)) + by;
    return c > 0 ? std::numbers::pi * std::max(0.0, square(c) / open - h2) / std::sqrt(open) : 0;
  };
  return std::min(whole, (area(slack) - area(-slack)) / square(least_radius(s)) * (1 + 1e-9));
}

}  // namespace marrow
