#include "field/blend/bounds/angle/alpha_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/blend/bounds/angle/field_weight.h"
#include "field/blend/bounds/angle/local_contact_angles.h"
#include "field/blend/bounds/angle/mean_angles.h"

namespace marrow {

AngleBounds angles_around(const AlphaSample& middle, const MeanChange& change, const Interval& range,
                          const SumBounds& sum) {
  const double most = change.slope, rho = sum.rho(), off = middle_is_off * most;
  AngleBounds bounds{range, {Interval::everything(), Interval::everything(), Interval::everything()}};
  if (!(most < Box3::inf)) return bounds;
  const bool is_bend_known = change.bend < Box3::inf;
  for (std::size_t k = 0; k < 3; ++k) {
    const double by = is_bend_known ? change.bend * rho + off : 2 * most;
    bounds.gradient[k] = clamped({middle.gradient[k] - by, middle.gradient[k] + by}, {-most, most});
  }
  double by = most * rho;
  if (is_bend_known) {
    double first = length(middle.gradient) * rho;
    if (const Stretch* way = sum.stretch())
      first = std::min(first, std::fabs(dot(middle.gradient, way->half)) + length(middle.gradient) * way->slack);
    by = std::min(by, first * (1 + middle_is_off) + (0.5 * change.bend * rho + off) * rho);
  }
  bounds.value = clamped({middle.value - by - 1e-12, middle.value + by + 1e-12}, range);
  return bounds;
}

AngleBounds alpha_bounds(const BlendField& blend, const SumBounds& sum, const Box3& box) {
  if (!blend.alpha_varies()) return {blend.alpha, {Interval(0), Interval(0), Interval(0)}};
  if (blend.alpha_source)
    return {clamped(blend.alpha_source->bounds(box), {-1, std::numbers::pi / 2}), blend.alpha_source->slopes(box)};
  return blend.local_contact ? local_contact_angles(blend, sum) : mean_angles(blend, sum);
}

}  // namespace marrow
