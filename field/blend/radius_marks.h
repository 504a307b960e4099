// The logarithms of radii as marks of skeletons, and what angle/local_contact.h is told by sums of these; internal to
// blend/.
#pragma once

#include <cstddef>

#include "field/blend/angle/local_contact.h"
#include "field/blend/blend_field.h"
#include "field/blend/sources/mark_sums.h"
#include "field/math/elementary.h"

namespace marrow {

/// That of the first skeleton, so that marks are exactly 0 where all have the same. 1 of a blend without skeletons.
inline double reference_radius(const BlendField& blend) {
  double radius = 0;
  blend.for_each_list([&](const auto& list) {
    if (radius == 0 && !list.empty()) radius = mean_radius(list.skeletons.front());
  });
  return radius == 0 ? 1 : radius;
}

/// Of a skeleton of a blend with this reference_radius().
template <class Skeleton>
double radius_mark(const PrimitiveList<Skeleton>& list, std::size_t i, double reference) {
  return list.log_radii.empty() ? log(mean_radius(list.skeletons[i]) / reference) : list.log_radii[i];
}

/// Whether a sum tells means over its skeletons.
inline bool is_usable(const SkeletonSample& sum) { return sum.value > 0 && sum.value <= field_ceiling; }

/// By sums of fields, of fields with marks, and of near fields, at one place; the last two as far as the rule asks.
inline Neighbourhood neighbourhood(const LocalContact& rule, const SkeletonSample& sum, const MarkSums& marks,
                                   const SkeletonSample& near) {
  Neighbourhood place{.field = sum.value,
                      .field_gradient = sum.gradient,
                      .spread_gradient = {},
                      .near_field = near.value,
                      .near_gradient = near.gradient};
  if (!rule.adapts_to_radii() || !is_usable(sum)) return place;
  const double f = sum.value, mean = marks.first / f, mean_square = marks.second / f;
  const Vec3d mean_gradient = (marks.first_gradient - sum.gradient * mean) / f;
  place.spread = 4 * (mean_square - mean * mean);
  place.spread_gradient = ((marks.second_gradient - sum.gradient * mean_square) / f - mean_gradient * (2 * mean)) * 4.0;
  return place;
}

}  // namespace marrow
