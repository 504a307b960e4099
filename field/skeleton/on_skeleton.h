// Where the inverse kernel is infinite; internal to skeleton/.
#pragma once

#include "field/skeleton/skeletons.h"
#include "field/skeleton/triangle_view.h"

namespace marrow {

inline bool is_on(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  return kernel.family == KernelFamily::Inverse &&
         arc_field<Derivatives::ScaleInvariant>(arc, p, kernel.degree).value > field_ceiling;
}

inline bool is_on(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family != KernelFamily::Inverse) return false;
  bool foot_is_inside = false;
  const TriangleView view = best_view(triangle, p, foot_is_inside);
  return foot_is_inside && view.p_normal == 0;
}

}  // namespace marrow
