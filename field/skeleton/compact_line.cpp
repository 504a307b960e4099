// Nodes between the ends of a support that move with the point.
#include "field/skeleton/compact_line.h"

#include "field/kernel/profile.h"
#include "field/skeleton/compact_rule.h"

namespace marrow {
namespace {

using X = HessianJet;

struct MovingLine {
  Vec3d u;
  Vec3<X> across;
  LineOf<X> line;
};

MovingLine seen_by(const SegmentSkeleton& s, const Vec3<X>& p, double length) {
  MovingLine seen;
  seen.u = (s.to - s.from) / length;
  const double slope = (s.radius_to - s.radius_from) / length;
  const X foot = dot(p - s.from, seen.u);
  const Vec3<X> across = p - s.from - constant<X>(seen.u) * foot;
  seen.across = across;
  seen.line = {-foot, length - foot, square(across.x) + square(across.y) + square(across.z),
               s.radius_from + slope * foot, slope};
  return seen;
}

// x^(m/2) of x > 0
X half_power(const X& x, int m) {
  const X whole = integer_power(x, m / 2);
  return m % 2 == 0 ? whole : whole * sqrt(x);
}

}  // namespace

SecondOrderSample compact_line(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel, bool share) {
  SecondOrderSample sum;
  const double length = marrow::length(s.to - s.from), R = kernel.shape;
  const auto [u, across, line] = seen_by(s, variables_at<HessianJet>(p), length);
  const Profile profile(kernel, 1);
  const int m = profile.degree();
  integrate_compact(line, R, kernel.degree, m, [&](const X& t, const X& weight) {
    const X tau = line.at_foot + line.slope * t, inside = 1.0 - (square(t) + line.h_squared) / (R * R * square(tau));
    if (!(inside.value > 0)) return;
    X part = weight / (profile.normalisation() * tau);
    if (share) part = part * (t - line.t1) * (1 / length);
    const X lower = half_power(inside, m - 2) * part;
    sum.field += lower * inside;
    const X fall = lower / tau * (-m / (R * R));
    for (std::size_t c = 0; c < 3; ++c) sum.si[c] += fall * (across[c] - u[c] * t);
  });
  return sum;
}

}  // namespace marrow
