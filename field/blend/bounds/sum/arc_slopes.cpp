// Derivatives of arcs by distance: where the nearest place may be, and how it moves.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "field/blend/bounds/sum/nearest_places.h"
#include "field/math/elementary.h"
#include "field/skeleton/nearest_place.h"

namespace marrow {
namespace {

using namespace nearest_places;

// An arc and a box in the frame of the arc: points (x, y, z) of the box, places major (cos, sin, 0) of the angle.
struct ArcAndBox {
  const ArcSkeleton& arc;
  Span from_center;  // of the world
  Interval x, y, z;
  double slope;       // of the radius, by the angle
  double begin, end;  // of the angles that may be nearest

  ArcAndBox(const ArcSkeleton& s, const Box3& box)
      : arc(s),
        from_center(span_of(box, s.center)),
        x(along(from_center, s.axis1)),
        y(along(from_center, s.axis2)),
        z(along(from_center, cross(s.axis1, s.axis2))),
        slope((s.radius_to - s.radius_from) / (s.end - s.begin)),
        begin(s.begin),
        end(s.end) {}

  bool is_ring() const { return slope == 0 && arc.end - arc.begin >= 2 * std::numbers::pi * (1 - 1e-12); }
  Interval radius(const Interval& angle) const { return arc.radius_from + slope * (angle - arc.begin); }
  Interval squared_distance(const IntervalSinCos& at) const {
    return square(x - arc.major * at.cos) + square(y - arc.major * at.sin) + square(z);
  }
  Interval scaled_squared(const Interval& angle) const {
    return squared_distance(sincos(angle)) / square(radius(angle));
  }
  // F = v.q' tau + |v|^2 tau', v = p - q, falls through 0 where e = |v| / tau is least: d(e^2) = -2 F / tau^3.
  Interval fall(const Interval& angle) const {
    const IntervalSinCos at = sincos(angle);
    return arc.major * (y * at.cos - x * at.sin) * radius(angle) + squared_distance(at) * slope;
  }
  Interval fall_slope(const Interval& angle) const {
    const IntervalSinCos at = sincos(angle);
    return -arc.major * ((x * at.cos + y * at.sin) * radius(angle) + (y * at.cos - x * at.sin) * slope);
  }
};

// The angle of the place that is nearest to p.
double nearest_angle(const ArcSkeleton& s, const Vec3d& p) {
  const NearestPlace nearest = nearest_place(s, p);
  const Vec3d place = p - s.center - nearest.to_point;
  const double turn = 2 * std::numbers::pi, share = nearest.shares[0].value;
  const double angle = atan2(dot(place, s.axis2), dot(place, s.axis1));
  const double expected = s.begin + share * (s.end - s.begin);
  return angle + turn * std::floor((expected - angle) / turn + 0.5);
}

// At most sin(x), by 2e-4 at most, of x from 0 to pi / 2: its alternating series ended behind a negative term.
double sine_at_least(double x) {
  const double x2 = x * x;
  return x * (1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42)));
}

// Which places of an arc may be nearest to some point of a box: those whose distance from its middle is at most half
// its diagonal more than `most` radii, a bound of e all over the box. At the angle x from that of the middle the
// squared distance is gap + 4 r major sin^2(x / 2).
class NearPlaces {
 public:
  NearPlaces(const ArcAndBox& seen, const Box3& box, double most)
      : seen_(seen), most_(most * (1 + 1e-12)), half_diagonal_(0.5 * length(box.size()) * (1 + 1e-12)) {
    const double x = seen.x.middle(), y = seen.y.middle(), z = seen.z.middle(), r = std::hypot(x, y);
    const double beside = r - seen.arc.major, slack = 1e-13 * (r * r + z * z + seen.arc.major * seen.arc.major);
    from_ = atan2(y, x);
    chord_ = 4 * r * seen.arc.major;
    gap_ = z * z + beside * beside - slack;  // less some hundred times what is rounded
  }
  // The place farthest from a, on the way to b, that may be nearest.
  double farthest(double a, double b, int halvings = 6) const {
    if (!may_hold({std::min(a, b), std::max(a, b)})) return a;
    if (halvings == 0) return b;
    const double middle = 0.5 * (a + b), far = farthest(middle, b, halvings - 1);
    return far != middle ? far : farthest(a, middle, halvings - 1);
  }

 private:
  bool may_hold(const Interval& angles) const {
    const double turn = 2 * std::numbers::pi;
    // Of the turns of `from` that before the last angle and the next one are nearest.
    const double before = from_ + turn * std::floor((angles.hi - from_) / turn);
    const double away = std::max(0.0, std::min(angles.lo - before, before + turn - angles.hi) - 1e-14 * turn);
    const double sine = sine_at_least(0.5 * away), reach = half_diagonal_ + most_ * seen_.radius(angles).hi;
    return gap_ + chord_ * (sine * sine) <= reach * reach;
  }

  const ArcAndBox& seen_;
  double most_, half_diagonal_;
  double from_, chord_, gap_;
};

// Angles among which is the nearest place of every point of the box, in one piece with that of its middle.
Interval near_angles(ArcAndBox& seen, const Box3& box) {
  double at = nearest_angle(seen.arc, box.center());
  if (seen.is_ring()) {
    seen.begin = at - std::numbers::pi;
    seen.end = at + std::numbers::pi;
  }
  at = std::clamp(at, seen.begin, seen.end);
  const NearPlaces near(seen, box, sqrt(seen.scaled_squared(at)).hi);
  return {near.farthest(at, seen.begin), near.farthest(at, seen.end)};
}

// Where F has one sign all over these angles the last of them is nearest, or the first. Where it falls, one of them is,
// and Newton's step from the middle narrows where: to an end, if the step may lead as far, or a root of F. Nothing
// where several may be.
std::optional<Interval> narrowed(const ArcAndBox& seen, Interval angles) {
  const Interval falls = seen.fall(angles);
  if (falls.lo > 0) return angles.hi;
  if (falls.hi < 0) return angles.lo;
  for (int step = 0; step < 4; ++step) {
    const Interval slope = seen.fall_slope(angles);
    if (!(slope.hi < 0)) return {};
    const double middle = angles.middle(), width = angles.width();
    angles = clamped(Interval(middle) - seen.fall(middle) / slope, angles);
    if (angles.width() > 0.5 * width) break;
  }
  return angles;
}

// The place at these angles moves by grad angle = -grad F / F', grad F = q' tau + 2 v tau'.
Place place_among(const ArcAndBox& seen, const Interval& angles, bool is_real) {
  const ArcSkeleton& s = seen.arc;
  const auto [sine, cosine] = sincos(angles);
  const Span place = times(s.axis1, s.major * cosine) + times(s.axis2, s.major * sine);
  const Span tangent = times(s.axis2, s.major * cosine) - times(s.axis1, s.major * sine);
  Place q{seen.from_center - place, seen.radius(angles), identity, is_real};
  const Interval over = -1.0 * (Interval(1) / seen.fall_slope(angles)), wider = seen.slope / q.radius;
  for (std::size_t j = 0; j < 3; ++j) {
    const Interval moves = (tangent[j] * q.radius + 2 * seen.slope * q.to_point[j]) * over;
    for (std::size_t i = 0; i < 3; ++i) q.turns[i][j] -= (tangent[i] + wider * q.to_point[i]) * moves;
  }
  return q;
}

}  // namespace

double place_speed(const ArcSkeleton& s, const Box3& box) {
  ArcAndBox seen(s, box);
  const auto angles = narrowed(seen, near_angles(seen, box));
  if (!angles) return Box3::inf;
  if (angles->width() == 0 && (angles->lo == s.begin || angles->lo == s.end)) return 0;
  const double away = sqrt(seen.squared_distance(sincos(*angles))).hi, falls = -seen.fall_slope(*angles).hi;
  const double most = s.major * seen.radius(*angles).hi + 2 * std::fabs(seen.slope) * away;
  return falls > 0 ? most / falls * (1 + 1e-9) : Box3::inf;
}

std::optional<PrimitiveSlopes> distance_slopes(const ArcSkeleton& s, const Box3& box, const Kernel& kernel) {
  ArcAndBox seen(s, box);
  const auto angles = narrowed(seen, near_angles(seen, box));
  if (!angles) return {};
  const double slack = 1e-12 * (std::fabs(s.begin) + std::fabs(s.end));
  const bool may_be_begin = !seen.is_ring() && angles->lo <= s.begin + slack;
  const bool may_be_end = !seen.is_ring() && angles->hi >= s.end - slack;
  Places places;
  const auto end_at = [&](double angle, double radius) {
    const Vec3d from_center = (s.axis1 * cos(angle) + s.axis2 * sin(angle)) * s.major;
    places.add({span_of(box, s.center + from_center), radius, identity, true});
  };
  if (angles->lo < angles->hi || !(may_be_begin || may_be_end))
    places.add(place_among(seen, *angles, !may_be_begin && !may_be_end));
  if (may_be_begin) end_at(s.begin, s.radius_from);
  if (may_be_end) end_at(s.end, s.radius_to);
  return places.slopes(kernel);
}

}  // namespace marrow
