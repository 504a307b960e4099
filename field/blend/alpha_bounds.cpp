#include "field/blend/alpha_bounds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "field/blend/gather.h"
#include "field/skeleton/distance.h"

namespace marrow {
namespace {

Interval skeleton_angles(const BlendField& blend) {
  Interval all(blend.alpha);
  blend.for_each_list([&](const auto& list) {
    for (const auto* angles : {&list.alphas, &list.alphas_to})
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
Interval local_contact_angles(const BlendField& blend, const SumBounds& sum) {
  const LocalContact& rule = *blend.local_contact;
  const Interval range = hull(rule.range(), blend.alpha);
  const auto place = may_jump(blend) ? std::nullopt : neighbourhood_at(blend, sum.center());
  const Interval f = sum.f();
  if (!place || !(f.lo > 1e-290 && f.hi < 0.9 * field_ceiling)) return range;
  const auto within = [&](double value, double rate, double error) {
    const double factor = rate * sum.rho() < 50 ? exp(rate * sum.rho()) * (1 + 1e-9) : Box3::inf;
    return Interval{std::max(0.0, value - error) / factor, (value + error) * factor};
  };
  constexpr double rounded = 1e-8;  // of sums and of what cancels in the variance; radii differ by e^20 at most
  const Interval spread = rule.adapts_to_radii() ? within(place->spread, 2 * sum.log_slope(), rounded) : Interval(0);
  if (!rule.adapts_to_density()) return rule.within(spread, 1);
  const double m = LocalContact::near_degree, n = blend.degree, near_slope = near_log_slope(blend, sum);
  const double rate = (m - 1) / (m - n) * (sum.log_slope() + (n - 1) / (m - 1) * near_slope);
  const double crowd = rule.crowd(*place);
  Interval crowds = within(crowd, rate, rounded * crowd);
  // Far away and close by the rule takes 1.
  const Interval near = within(place->near_field, near_slope, 0);
  if (near.lo < 1e-240 || near.hi > 0.9 * field_ceiling) crowds = {1, Box3::inf};
  return clamped(rule.within(spread, crowds), range);
}

}  // namespace

Interval alpha_bounds(const BlendField& blend, const SumBounds& sum, const Box3& box) {
  if (!blend.alpha_varies()) return blend.alpha;
  if (blend.alpha_source) return clamped(blend.alpha_source->bounds(box), {-1, std::numbers::pi / 2});
  if (blend.local_contact) return local_contact_angles(blend, sum);
  const double middle = alpha_at(blend, sum.center()).value;
  if (blend.alpha_per_skeleton && may_jump(blend)) return skeleton_angles(blend);
  if (blend.alpha_per_skeleton) return around(middle, sum.log_slope(), sum.rho(), skeleton_angles(blend));
  // Weights f_i f_j are twice as steep, as is the mean direction v of a strand; u = v / |v| and so u_i . u_j changes by
  // 2 (2 slope) / |v|, its eighth power by eight times that.   [Zanni et al. 2015, eq. 15 and 16]
  const double mean = least_mean_direction(blend);
  const Interval range = direction_angles(blend);
  if (!(mean > 0) || may_jump(blend)) return range;
  const double steep = mean < 1 ? 2 + 32 / mean : 2;
  return around(middle, steep * sum.log_slope(), sum.rho(), range);
}

}  // namespace marrow
