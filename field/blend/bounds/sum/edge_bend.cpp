// With Q = R^2 tau^2 - d^2, w = Q / (R tau)^2.
//   m = 3: second derivatives of the kernel are at most 3 / (R tau)^2 w^(-1/2), w^(-1/2) = R tau / sqrt(Q).
//   m = 2: they are 2 / (R tau)^2 and, at the edge, delta(w) |grad w|^2 = 4 delta(Q).
// What is known of the integral of 1 / sqrt(Q) over that part of a stretch where Q is positive:
//   Q'' <= -c: Q is at least c/2 times the ways to both ends of that part, so that it is at most pi sqrt(2/c);
//   |Q'| >= g over a width W: Q is at least g times the way to one end, so that it is at most 2 sqrt(W/g);
//   Q >= q: at most W / sqrt(q).
#include "field/blend/bounds/sum/edge_bend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/blend/bounds/sum/support_share.h"
#include "field/math/box3.h"
#include "field/math/elementary.h"
#include "field/number/functions.h"
#include "field/skeleton/arc_view.h"
#include "field/skeleton/corners.h"
#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/reach.h"
#include "field/skeleton/seen_line.h"

namespace marrow {
namespace {

using std::numbers::pi;

constexpr double inf = Box3::inf, more = 1 + 1e-9, less = 1 - 1e-9;

double if_bent(double c) { return c > 0 ? pi * std::sqrt(2 / c) : inf; }
double if_steep(double width, double g) { return g > 0 ? 2 * std::sqrt(width / g) : inf; }
double if_inside(double width, double q) { return q > 0 ? width / std::sqrt(q) : inf; }

// From an integral of 1 / (tau^2 sqrt(Q)) over a curve, for m = 3.
double bend_of(double integral, const Profile& profile, double R) {
  return 3 / (R * profile.normalisation()) * integral * more;
}

// Q along a circle, by the angle x from that at which the middle of the ball stands: from each place in the ball
//   Q = R^2 tau^2 - (rest - 2 major out cos(x - off)),
// `out` from the axis and `off` from the angle of the middle.
class AroundCircle {
 public:
  static constexpr double bent = pi / 3;  // up to there the circle bends towards the place

  AroundCircle(const ArcSkeleton& s, double R, const Vec3d& p, double rho)
      : pieces_(s.radius_from != s.radius_to && s.end - s.begin > 2 * (pi - bent) ? 2 : 1),
        reach_(R * largest_radius(s)),
        least_reach_(R * least_radius(s)),
        steep_(R * std::fabs(s.radius_to - s.radius_from) / (s.end - s.begin)) {
    const ArcView view = view_from(s, p);
    rho_ = rho * more + 1e-14 * (s.major + view.r);  // of places that are rounded
    nearest2_ = view.gap();
    pull_ = 2 * s.major * view.r;
    least_pull_ = 2 * s.major * std::max(0.0, view.r - rho_);
    most_off_ = rho_ < view.r ? asin(rho_ / view.r) * more : pi;
  }

  // Up to this angle the support reaches from some place.
  double end() const {
    const double left = std::max(0.0, square(reach_ * more + rho_) - nearest2_ * less);
    return left < 2 * pull_ ? 2 * asin(std::sqrt(left / (2 * pull_))) * more : pi;
  }

  // The integral of 1 / sqrt(Q) over the angles from 0 <= from to to <= pi on one side.
  double beside(double from, double to) const {
    const double farthest = (std::sqrt(nearest2_ + 2 * pull_ * square(sin(0.5 * to))) + rho_) * more;
    const double low = from - most_off_, high = to + most_off_;
    const double sine = low > 0 && high < pi ? std::min(sin(low), sin(high)) * less : 0;
    return std::min(if_inside(to - from, square(least_reach_) - square(farthest)),
                    if_steep(pieces_ * (to - from), least_pull_ * sine - 2 * reach_ * steep_));
  }
  // The same on both sides of 0.
  double about(double to) const {
    const double cosine = to + most_off_ < pi ? cos(to + most_off_) * less : -1;
    return std::min(pieces_ * if_bent(least_pull_ * cosine - 2 * square(steep_)), 2 * beside(0, to));
  }

 private:
  int pieces_;  // of what is looked at, where the gap of an arc with another radius behind it lies
  double reach_, least_reach_, steep_;  // of R tau, the last by the angle
  double rho_, nearest2_, pull_, least_pull_, most_off_;
};

// About the angle of the place all at once, on either side in parts that grow shorter towards the far end.
double integral_along(const ArcSkeleton& s, double R, const Vec3d& p, double rho) {
  constexpr int parts = 6;
  const AroundCircle circle(s, R, p, rho);
  const double end = circle.end();
  double from = AroundCircle::bent, integral = circle.about(std::min(from, end));
  for (int i = 1; i <= parts && from < end; ++i) {
    const double to = i == parts ? end : std::min(end, from + 0.5 * (pi - from));
    integral += 2 * circle.beside(from, to);
    from = to;
  }
  return s.major * integral;
}

// Along a segment 1 / sqrt(Q) is the density of the arcsine law on an interval of 2 l, over sqrt(1 - (R tau')^2), and
// of mass pi. If one end of such an interval moves in or out by a share e of the longer one, densities differ by 4
// asin(sqrt(e)) in all. Here: both ends, as from p to places within `step`.
double roots_moved(const SegmentSkeleton& s, double R, const Vec3d& p, double step) {
  constexpr double all = 2 * pi;
  const Line line = seen_from(s, p).line;
  const Reach<double> reach = reach_along(line, R);
  if (reach.is_empty) return all;
  const double open = 1 - square(R * line.slope), l = reach.half_rise / open;
  // R tau within 2 l of the middle, which holds the roots of Q + by.
  const double largest = R * (line.at_foot / open + 2 * std::fabs(line.slope) * l);
  const double by = step * (2 * largest + 3 * step) * more / (open * square(l));
  if (!(by < 1)) return all;
  const double inward = by / (1 + std::sqrt(1 - by));
  return std::min(all, 8 * asin(std::sqrt(std::min(1.0, inward / (2 - inward)))));
}

// What of a triangle the support may reach from a place in the ball: radii from `thin` to `thick`, `width` across the
// lines along which the radius stays as it is; of one radius, across the longest side.
struct Strip {
  double thin, thick, width;
  double open;  // 1 - (R grad tau)^2

  bool is_empty() const { return !(thin <= thick); }
};

Strip strip_of(const TriangleSkeleton& s, double R, const Vec3d& p, double rho) {
  const Corners corners(s);
  const Vec3d rise = corners.gradient_of(s.radii);
  const double steep = length(rise), open = 1 - square(R * steep * more);
  if (steep == 0) {
    const double reach = R * s.radii[0];
    return {s.radii[0], s.radii[0], std::min(2 * reach, std::sqrt(corners.area2) / extent(s)), open};
  }
  Strip strip{least_radius(s), largest_radius(s), 0, open};
  if (open > 0) {
    // d <= R tau + rho, up the slope from the foot: where the support reaches with radii that are rho / R larger. A
    // slope that is too large makes radii downhill too small, so that those at the foot are larger by twice as much.
    const Vec3d from_corner = p - s.vertices[0];
    const double at_foot = s.radii[0] + dot(from_corner, rise), slack = 1e-9 * strip.thick;
    const double h2 = square(dot(from_corner, corners.normal)) / corners.area2 * less;
    const Reach<double> reach = reach_along(Line{-inf, inf, h2, (at_foot + rho / R) * square(more), steep * more}, R);
    if (reach.is_empty) return {inf, 0, 0, open};
    if (reach.from) strip.thin = std::max(strip.thin, at_foot + steep * *reach.from - slack);
    if (reach.to) strip.thick = std::min(strip.thick, at_foot + steep * *reach.to + slack);
  }
  strip.width = (strip.thick - strip.thin) / steep;
  return strip;
}

}  // namespace

// They have m >= 4, so that nothing asks: for templates over skeletons.
double edge_bend(const PointSkeleton&, const Profile&, double, const Vec3d&, double) { return inf; }

// Q'' = -2 (1 - (R tau')^2) along it.
double edge_bend(const SegmentSkeleton& s, const Profile& profile, double R, const Vec3d&, double) {
  const double slope = (s.radius_to - s.radius_from) / length(s.to - s.from);
  return bend_of(if_bent(2 * (1 - square(R * slope * more))), profile, R) / square(least_radius(s));
}

double edge_bend(const ArcSkeleton& s, const Profile& profile, double R, const Vec3d& p, double rho) {
  return bend_of(integral_along(s, R, p, rho), profile, R) / square(least_radius(s));
}

// On a line along which the radius stays as it is Q'' = -2, so that the integral of 1 / sqrt(Q) is at most pi, and that
// of tau^-3 times it across these lines pi (thin + thick) / (2 thin^2 thick^2) of the width. The integral of delta(Q)
// is 1 / sqrt(the largest Q of a line); that has Q'' = -2 (1 - (R grad tau)^2) across.
double edge_bend(const TriangleSkeleton& s, const Profile& profile, double R, const Vec3d& p, double rho) {
  const Strip strip = strip_of(s, R, p, rho);
  if (strip.is_empty()) return 0;
  const double thin2 = square(strip.thin), thick2 = square(strip.thick);
  if (profile.degree() == 3) {
    const double in_ball = 2 * R * strip.thick / (thin2 * strip.thin);  // no place has more of it within its reach
    return bend_of(pi * std::min(in_ball, strip.width * (strip.thin + strip.thick) / (2 * thin2 * thick2)), profile, R);
  }
  const double held = share_within(s, R * strip.thick) * square(least_radius(s));
  const double even = 2 / (R * R) * held / square(thin2), at_edge = 4 * if_bent(2 * strip.open) / thin2;
  return (even + at_edge) / profile.normalisation() * more;
}

// Second derivatives of the kernel are -a w^(1/2) + b w^(-1/2) v v^T, a = 3/R^2, b = 3/R^4, v the scaled way.
double edge_bend_change(const SegmentSkeleton& s, const Profile& profile, double R, const Vec3d& p, double step) {
  constexpr double least_open = 1e-5;  // so that rounding is some 1e-11 of it, which `more` holds
  const double open = 1 - square(R * (s.radius_to - s.radius_from) / length(s.to - s.from));
  if (!(open > least_open)) return inf;
  const double moved = roots_moved(s, R, p, step), least = least_radius(s), far = step / least;
  const double a = 3 / (R * R), b = a / (R * R), changed = far * (2 * R + far);  // of d^2, scaled
  const double held = share_within(s, R * largest_radius(s) + step);
  const double at_edge = b * R / std::sqrt(open) * (square(R + far) * moved + changed * pi);
  return (at_edge + a * std::sqrt(changed) / R * held) / (profile.normalisation() * least) * more;
}

}  // namespace marrow
