#include "field/tree/nodes/local_convolution.h"

#include <algorithm>

namespace marrow {

std::string LocalConvolution::problem(std::size_t) const {
  if (radius.size() != 1 && radius.size() != points.size()) return "radius must be one number or one for each point";
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    if (points[k] == points[k + 1]) return "neighbouring points must differ";
  return {};
}

Box3 LocalConvolution::extent(double level) const {
  Box3 box;
  for (const Vec3d& p : points) box.include(p);
  const double R = *std::max_element(radius.begin(), radius.end());
  const double seen = std::min(2 * reach, PlaneChain(points).length());
  return box.padded(pow(seen * R * R / (2 * level), 1.0 / 3) * (1 + 1e-9));
}

}  // namespace marrow
