// The logarithms of radii as marks of skeletons, whose variance is the spread of angle/local_contact.h; internal to
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

/// Sets the spread, 4 times the variance, by the field and its gradient. Precondition: that field is above 0.
inline void set_spread(const MarkSums& marks, Neighbourhood& place) {
  const double f = place.field, mean = marks.first / f, mean_square = marks.second / f;
  const Vec3d mean_gradient = (marks.first_gradient - place.field_gradient * mean) / f;
  place.spread = 4 * (mean_square - mean * mean);
  place.spread_gradient =
      ((marks.second_gradient - place.field_gradient * mean_square) / f - mean_gradient * (2 * mean)) * 4.0;
}

}  // namespace marrow
