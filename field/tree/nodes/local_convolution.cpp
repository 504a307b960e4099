#include "field/tree/nodes/local_convolution.h"

#include <algorithm>

namespace marrow {

std::string LocalConvolution::problem(std::size_t) const {
  if (radius.size() != 1 && radius.size() != points.size()) return "radius must be one number or one for each point";
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    if (points[k] == points[k + 1]) return "neighbouring points must differ";
  return {};
}

// As extent(): all that is seen from the place lies within its length of it.
double LocalConvolution::at_most(const PlaneChain& chain, double widest, const Vec3d& p, double rho,
                                 const Interval& place) const {
  const double middle = place.middle(), to_end = reach + (place.hi - middle) + (middle - place.lo);
  const double away = (length(p - chain.position(middle)) - to_end - rho) * (1 - 1e-9);
  if (!(away > 0)) return Box3::inf;
  return std::min(2 * to_end, chain.length()) * square(widest) / (2 * away * square(away)) * (1 + 1e-9);
}

Box3 LocalConvolution::extent(double level) const {
  Box3 box;
  for (const Vec3d& p : points) box.include(p);
  const double R = largest_radius();
  const double seen = std::min(2 * reach, PlaneChain(points).length());
  return box.padded(pow(seen * R * R / (2 * level), 1.0 / 3) * (1 + 1e-9));
}

}  // namespace marrow
