// Cells as where hardly a ray comes.
#pragma once

#include <limits>
#include <memory>

#include "field/trace/blend_tracer.h"
#include "field/trace/cells/ray_spacing.h"

namespace marrow::test {

inline std::shared_ptr<const RaySpacing> hardly_a_ray() {
  return std::make_shared<const RaySpacing>(
      RaySpacing{.views = {{.eye = {}, .constant = std::numeric_limits<double>::infinity()}}});
}

inline TraceOptions large_cells() {
  TraceOptions options;
  options.spacing = hardly_a_ray();
  options.eighths = true;
  return options;
}

}  // namespace marrow::test
