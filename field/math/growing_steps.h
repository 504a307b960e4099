// From a place along a way by steps that grow, so that the first of them may be as short as places are told apart.
#pragma once

#include <optional>

#include "field/math/vec3.h"

namespace marrow {

/// first, first * factor, ... as long as they are below `end`. None where the first is 0.
struct GrowingSteps {
  double first, factor, end;
};

/// The first of from + way * step for which `is_wanted` holds.
template <class IsWanted>
std::optional<Vec3d> first_place_along(const Vec3d& from, const Vec3d& way, const GrowingSteps& steps,
                                       const IsWanted& is_wanted) {
  for (double step = steps.first; step > 0 && step < steps.end; step *= steps.factor)
    if (const Vec3d p = from + way * step; is_wanted(p)) return p;
  return {};
}

}  // namespace marrow
