#include "field/blend/alpha_bounds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "field/blend/gather.h"
#include "field/blend/mean_angles.h"
#include "field/skeleton/distance.h"

namespace marrow {
namespace {

Interval skeleton_angles(const BlendField& blend) {
  Interval all(blend.alpha);
  blend.for_each_list([&](const auto& list) {
    for (const auto* angles : {&list.alphas, &list.alphas_to, &list.alphas_third})
      for (const double a : *angles) all = hull(all, a);
  });
  return all;
}

Interval direction_angles(const BlendField& blend) {
  Interval all(blend.alpha);
  for (const DirectionBounds& b : blend.direction_bounds)
    all = hull(all, {std::min(b.least, b.most), std::max(b.least, b.most)});
  return all;
}

// The least length of the mean direction of any strand, whatever the weights of its segments: all of them lie within
// some angle of the strand's axis. Not above 0: nothing is known.
double least_mean_direction(const BlendField& blend) {
  std::map<std::uint32_t, std::vector<Vec3d>> strands;
  for (const auto* list : {&blend.segments, &blend.distance_segments, &blend.cani_hornus_segments})
    for (std::size_t i = 0; i < list->strands.size(); ++i)
      strands[list->strands[i]].push_back(normalize(list->skeletons[i].to - list->skeletons[i].from).vec());
  if (!blend.arcs.empty() || !blend.distance_arcs.empty()) return 0;
  double least = 1;
  for (const auto& [number, directions] : strands) {
    Vec3d sum{};
    for (const Vec3d& d : directions) sum += d;
    const UnitVec3 axis = normalize(sum);
    for (const Vec3d& d : directions) least = std::min(least, dot(axis, d));
  }
  return least;
}

// A mean of values within `range` whose weights have logarithms no steeper than `slope` moves by range * slope * rho at
// most: its gradient is the sum of w_i (a_i - mean) grad ln w_i.
Interval around(double middle, double slope, double rho, const Interval& range) {
  const double by = range.width() * slope * rho * (1 + 1e-9) + 1e-12;
  if (!(by < range.width())) return range;
  return clamped({middle - by, middle + by}, range);
}

// Under the distance model one segment of a strand takes over from another, with its angle, direction and radius.
bool may_jump(const BlendField& blend) {
  const auto& strands = blend.distance_segments.strands;
  return std::adjacent_find(strands.begin(), strands.end()) != strands.end();
}

// Where the angle of a skeleton is taken at one place of it, that place may move fast.
bool may_turn_fast(const BlendField& blend) {
  const auto varies = [](const auto& list) {
    for (std::size_t i = 0; i < list.alphas.size(); ++i)
      if (list.angle_varies(i)) return true;
    return false;
  };
  return varies(blend.distance_segments) || varies(blend.cani_hornus_segments) || varies(blend.distance_triangles) ||
         varies(blend.distance_arcs);
}

Vec3<Interval> up_to(double length) { return {{-length, length}, {-length, length}, {-length, length}}; }
const Vec3<Interval> any_slope = up_to(Box3::inf);

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
  if (!place || !(f.lo > 1e-290 && f.hi < 0.9 * field_ceiling)) return {range, any_slope};
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

// Of the mean of values within `range` with weights whose derivatives are at most `first` and `second` times
// themselves: the gradient is the covariance of values and grad ln w_i, at most range / 2 first; its derivative is
//   sum w_i (a_i - mean) D^2 w_i / w_i - 2 grad mean grad ln w,   at most range / 2 (second + 2 first^2).
Vec3<Interval> slopes_of_mean(const Vec3d& middle, double range, double first, double second, double rho) {
  const double most = 0.5 * range * first * (1 + 1e-9), by = 0.5 * range * (second + 2 * first * first) * rho;
  Vec3<Interval> slopes = up_to(most);
  if (!(by < most)) return slopes;
  for (std::size_t i = 0; i < 3; ++i)
    slopes[i] = clamped({middle[i] - by - 1e-8 * most, middle[i] + by + 1e-8 * most}, slopes[i]);
  return slopes;
}

AngleBounds per_skeleton_angles(const BlendField& blend, const SumBounds& sum) {
  const Interval range = skeleton_angles(blend);
  const double steep = sum.log_slope();
  if (may_jump(blend) || may_turn_fast(blend) || !(steep < Box3::inf)) return {range, any_slope};
  const AlphaSample middle = alpha_at(blend, sum.center());
  // |D^2 f_i| <= m (m + 1) / d^2 f_i, and m >= 2
  return {around(middle.value, steep, sum.rho(), range),
          slopes_of_mean(middle.gradient, range.width(), steep, 1.5 * steep * steep, sum.rho())};
}

// Weights f_i f_j are twice as steep, as is the mean direction v of a strand; u = v / |v| and so u_i . u_j changes by
// 2 (2 slope) / |v|, its eighth power by eight times that. Straight strands keep theirs.  [Zanni et al. 2015, eq. 15,
// 16]
AngleBounds directional_angles(const BlendField& blend, const SumBounds& sum) {
  const double mean = least_mean_direction(blend), s = sum.log_slope();
  const Interval range = direction_angles(blend);
  if (!(mean > 0) || may_jump(blend) || !(s < Box3::inf)) return {range, any_slope};
  const AlphaSample middle = alpha_at(blend, sum.center());
  if (mean > 1 - 1e-12)
    return {around(middle.value, 2 * s, sum.rho(), range),
            slopes_of_mean(middle.gradient, range.width(), 2 * s, (2 * 1.5 + 2) * s * s, sum.rho())};
  const double steep = (2 + 32 / mean) * s;
  return {around(middle.value, steep, sum.rho(), range), up_to(range.width() * steep * (1 + 1e-9))};
}

}  // namespace

AngleBounds alpha_bounds(const BlendField& blend, const SumBounds& sum, const Box3& box) {
  if (!blend.alpha_varies()) return {blend.alpha, up_to(0)};
  if (blend.alpha_source)
    return {clamped(blend.alpha_source->bounds(box), {-1, std::numbers::pi / 2}), blend.alpha_source->slopes(box)};
  if (blend.local_contact) return local_contact_angles(blend, sum);
  if (const auto mean = mean_angles(blend, sum)) return *mean;
  return blend.alpha_per_skeleton ? per_skeleton_angles(blend, sum) : directional_angles(blend, sum);
}

}  // namespace marrow
