// A tracer asked tile by tile, without a hierarchy.
#pragma once

#include <optional>

#include "field/trace/blend_tracer.h"

namespace marrow::test {

/// t of the nearest hit of all tiles; with `any` of some hit of each.
inline std::optional<double> first_hit(const BlendTracer& tracer, const Ray& ray, bool any = false) {
  std::optional<double> first;
  for (std::size_t i = 0; i < tracer.tile_count(); ++i) {
    CellLog log;
    const auto hit = tracer.first_hit(i, ray, any, log);
    if (hit && (!first || hit->t < *first)) first = hit->t;
  }
  return first;
}

}  // namespace marrow::test
