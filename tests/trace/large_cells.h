// Cells as where hardly a ray comes.
#pragma once

#include <limits>
#include <memory>

#include "field/trace/blend_tracer.h"
#include "field/trace/cells/ray_spacing.h"

namespace marrow::test {

inline TraceOptions large_cells() {
  RaySpacing few;
  few.views.push_back({.eye = {}, .constant = std::numeric_limits<double>::infinity()});
  TraceOptions options;
  options.spacing = std::make_shared<const RaySpacing>(few);
  options.eighths = true;
  return options;
}

}  // namespace marrow::test
