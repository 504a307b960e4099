#include "field/tree/nodes/plane.h"

namespace marrow {

Box3 Plane::support() const {
  constexpr Vec3d unbounded{Box3::inf, Box3::inf, Box3::inf};
  Box3 box{-unbounded, unbounded};
  for (std::size_t i = 0; i < 3; ++i) {
    const double along = normal.vec()[i];
    if (along != 1 && along != -1) continue;
    const Box3 at = reached({point, point}, range_of(potential));
    if (along > 0) box.upper[i] = at.upper[i];
    else box.lower[i] = at.lower[i];
  }
  return box;
}

}  // namespace marrow
