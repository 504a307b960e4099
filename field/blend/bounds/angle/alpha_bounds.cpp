#include "field/blend/bounds/angle/alpha_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/blend/bounds/angle/mean_angles.h"
#include "field/blend/gather.h"
#include "field/skeleton/distance.h"

namespace marrow {
namespace {

// Under the distance model one segment of a strand takes over from another, with its angle, direction and radius.
bool may_jump(const BlendField& blend) {
  const auto& strands = blend.distance_segments.strands;
  return std::adjacent_find(strands.begin(), strands.end()) != strands.end();
}

Vec3<Interval> up_to(double length) { return {{-length, length}, {-length, length}, {-length, length}}; }
const Vec3<Interval> unknown_slope = up_to(Box3::inf);

// |grad ln| of the near field, which sums the kernel of another degree over the same skeletons. A skeleton of dimension
// d is a sum of |p - q|^-(m - 1 + d).   [tracing 3.1]
double near_log_slope(const BlendField& blend, const SumBounds& sum) {
  double steepest = 0;
  const auto add = [&](const auto& list, int power) {
    for (const auto& s : list.skeletons) {
      const double distance = distance_to(s, sum.center()) - sum.rho();
      steepest = std::max(steepest, distance > 0 ? power / distance * (1 + 1e-9) : Box3::inf);
    }
  };
  constexpr int m = LocalContact::near_degree;
  add(blend.points, m - 1);
  for (const auto* list : {&blend.segments, &blend.distance_segments, &blend.cani_hornus_segments}) add(*list, m);
  for (const auto* list : {&blend.triangles, &blend.distance_triangles}) add(*list, m + 1);
  for (const auto* list : {&blend.arcs, &blend.distance_arcs}) add(*list, m);
  return steepest;
}

// The spread is a variance of constants whose weights have logarithms no steeper than s: its derivative is the
// covariance of grad ln w_i with the squared deviations, at most 2 s times itself. So it grows by e^(2 s rho) at most.
// The crowd is a product of powers of f and of the near field, and grows alike.
AngleBounds local_contact_angles(const BlendField& blend, const SumBounds& sum) {
  const LocalContact& rule = *blend.local_contact;
  const Interval range = hull(rule.range(), blend.alpha);
  const auto place = may_jump(blend) ? std::nullopt : neighbourhood_at(blend, sum.center());
  const Interval f = sum.f();
  if (!place || !(f.lo > 1e-290 && f.hi < 0.9 * field_ceiling)) return {range, unknown_slope};
  const auto within = [&](double value, double rate, double error) {
    const double factor = rate * sum.rho() < 50 ? exp(rate * sum.rho()) * (1 + 1e-9) : Box3::inf;
    return Interval{std::max(0.0, value - error) / factor, (value + error) * factor};
  };
  constexpr double rounded = 1e-8;  // of sums and of what cancels in the variance; radii differ by e^20 at most
  const Interval spread = rule.adapts_to_radii() ? within(place->spread, 2 * sum.log_slope(), rounded) : Interval(0);
  const double by_spread = rule.steepest(spread) * 2 * sum.log_slope() * spread.hi * (1 + 1e-9);
  if (!rule.adapts_to_density()) return {rule.within(spread, 1), up_to(by_spread)};
  const double m = LocalContact::near_degree, n = blend.degree, near_slope = near_log_slope(blend, sum);
  const double rate = (m - 1) / (m - n) * (sum.log_slope() + (n - 1) / (m - 1) * near_slope);
  const double crowd = rule.crowd(*place);
  Interval crowds = within(crowd, rate, rounded * crowd);
  // Far away and close by the rule takes 1.
  const Interval near = within(place->near_field, near_slope, 0);
  if (near.lo < 1e-240 || near.hi > 0.9 * field_ceiling) crowds = {1, Box3::inf};
  const double by_crowd = rule.steepest_by_crowd(crowds) * rate * crowds.hi * (1 + 1e-9);
  return {clamped(rule.within(spread, crowds), range), up_to(by_spread + by_crowd)};
}

}  // namespace

AngleBounds alpha_bounds(const BlendField& blend, const SumBounds& sum, const Box3& box) {
  if (!blend.alpha_varies()) return {blend.alpha, up_to(0)};
  if (blend.alpha_source)
    return {clamped(blend.alpha_source->bounds(box), {-1, std::numbers::pi / 2}), blend.alpha_source->slopes(box)};
  if (blend.local_contact) return local_contact_angles(blend, sum);
  return mean_angles(blend, sum);
}

}  // namespace marrow
