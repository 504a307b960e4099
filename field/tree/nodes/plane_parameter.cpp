#include "field/tree/nodes/plane_parameter.h"

namespace marrow {

// A hairpin, where the edges' directions cancel, takes the plane across the edge that ends there.
PlaneChain::PlaneChain(std::span<const Vec3d> vertices) : points(vertices), start{0} {
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Vec3d edge = points[k + 1] - points[k];
    along.push_back(normalize(edge));
    start.push_back(start.back() + marrow::length(edge));
  }
  normal.push_back(along.front());
  for (std::size_t k = 1; k < along.size(); ++k) {
    const Vec3d sum = along[k - 1] + along[k];
    normal.push_back(length_squared(sum) > 1e-12 ? normalize(sum).vec() : along[k - 1]);
  }
  normal.push_back(along.back());
}

}  // namespace marrow
