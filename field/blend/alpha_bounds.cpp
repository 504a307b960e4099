#include "field/blend/alpha_bounds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

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

}  // namespace

Interval alpha_bounds(const BlendField& blend, const SumBounds& sum, const Box3& box) {
  if (!blend.alpha_varies()) return blend.alpha;
  if (blend.alpha_source) return clamped(blend.alpha_source->bounds(box), {-1, std::numbers::pi / 2});
  if (blend.local_contact) return {blend.local_contact->least(), std::numbers::pi / 2};
  const double middle = alpha_at(blend, sum.center()).value;
  if (blend.alpha_per_skeleton) return around(middle, sum.log_slope(), sum.rho(), skeleton_angles(blend));
  // Weights f_i f_j are twice as steep, as is the mean direction v of a strand; u = v / |v| and so u_i . u_j changes by
  // 2 (2 slope) / |v|, its eighth power by eight times that.   [Zanni et al. 2015, eq. 15 and 16]
  const double mean = least_mean_direction(blend);
  const Interval range = direction_angles(blend);
  if (!(mean > 0)) return range;
  const double steep = mean < 1 ? 2 + 32 / mean : 2;
  return around(middle, steep * sum.log_slope(), sum.rho(), range);
}

}  // namespace marrow
