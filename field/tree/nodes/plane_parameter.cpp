#include "field/tree/nodes/plane_parameter.h"

#include <algorithm>

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

Vec3d PlaneChain::position(double at) const {
  const auto behind = std::upper_bound(start.begin() + 1, start.end() - 1, at);
  const auto edge = static_cast<std::size_t>(behind - start.begin()) - 1;
  return points[edge] + along[edge] * (at - start[edge]);
}

std::pair<std::size_t, std::size_t> PlaneChain::edges_within(double from, double to) const {
  const auto vertices_up_to = [&](double at) {
    return static_cast<std::size_t>(std::upper_bound(start.begin(), start.end(), at) - start.begin());
  };
  const std::size_t before = vertices_up_to(from), behind = vertices_up_to(to);
  return {before > 2 ? before - 2 : 0, std::min(behind + 1, along.size())};
}

}  // namespace marrow
