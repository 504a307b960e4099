#include "field/trace/cells/divider.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"
#include "field/trace/sources/near_groups.h"

namespace marrow {
namespace {

// A thread beside a limb hardly shows in the mean radius around it. In a cell of some 300 thread radii positions in
// float moved the field by 3e-4; cells of the size of 20 radii times CellTreeSettings::cell_size move it by 1e-6 n.
constexpr double most_over_thinnest = 20;

}  // namespace

Vec3d octant_center(const Vec3d& center, double half, int octant) {
  const double q = half / 2;
  return {center.x + (octant & 1 ? q : -q), center.y + (octant & 2 ? q : -q), center.z + (octant & 4 ? q : -q)};
}

Divider::Divider(const SourceTree& tree, const NearFar& coarse, const IsoCurve& iso, const BlockKernels& kernels,
                 int degree)
    : tree_(tree), coarse_(coarse), iso_(iso), kernels_(kernels), degree_(degree) {}

Divider::Side Divider::side(const OctantBounds& near, const FarField::Bounds& far) const {
  const double f_far_low = std::max(0.0, far.f_center - far.f_variation);
  const double f_low = near.f_low + f_far_low;
  if (!near.touches) {
    const double f_high = near.f_high + far.f_center + far.f_variation;
    const double gradient_high = near.gradient_high + length(far.gradient_center) + far.gradient_variation;
    if (iso_.outside(0, f_high, gradient_high)) return Side::Outside;
  }
  return iso_.inside(f_low, 0) ? Side::Inside : Side::Mixed;
}

// Beyond this distance from every piece the field is below 1 even if all sources stood at that distance.
double Divider::influence() const {
  double radius = 0;
  for (const Piece& p : tree_.pieces()) radius = std::max(radius, p.radius);
  const auto outside = [&](double d) {
    double f = 0, gradient = 0;
    for (const SourceRef root : tree_.roots()) {
      const SourceNode& n = tree_.node(root.index());
      const double raised = integer_power(d, n.exponent);
      f += n.mass / raised;
      gradient += n.exponent * n.tau_mass / raised / d;
    }
    return iso_.outside(0, f, gradient);
  };
  double d = radius;
  while (!outside(d) && d < 1e6 * radius) d *= 1.25;
  return d;
}

CubeView Divider::root() const {
  Box3 box;
  for (const Piece& p : tree_.pieces()) box.include(p.box());
  CubeView root;
  // On a coarse binary grid, so that the planes of all cells are exact numbers and neighbours share them.
  const double needed = max_component(box.size()) / 2 + influence();
  const double grid = std::ldexp(1.0, std::ilogb(needed) - 10);
  root.half = std::ceil(needed / grid + 1) * grid;
  for (std::size_t i = 0; i < 3; ++i) root.center[i] = std::floor(box.center()[i] / grid + 0.5) * grid;
  root.sources = KeptSurroundings(refined(coarse_, tree_, nullptr, 0, root.center, root.half, largest_coarse_group));
  return root;
}

std::array<Divider::Octant, 8> Divider::octants(const CubeView& parent) const {
  const NearGroups near(tree_, parent.sources.near, parent.center, parent.half);
  std::array<OctantBounds, 8> bounds;
  kernels_.octant_bounds(near.data(), near.curve_groups(), near.point_groups(), degree_, bounds.data());
  const FarField far = parent.sources.far.whole();
  const FarField::Bounds far_bounds = far.bounds();
  std::array<Octant, 8> result;
  for (int i = 0; i < 8; ++i) {
    const OctantBounds& b = bounds[static_cast<std::size_t>(i)];
    Octant& octant = result[static_cast<std::size_t>(i)];
    octant.mixed = side(b, far_bounds) == Side::Mixed && side(b, far.of_child(i).bounds()) == Side::Mixed;
    // Where all is far the field is smooth, and no smaller cube would know more of it.
    octant.local_radius = b.weight > 0 ? parent.half * static_cast<double>(b.weighted_radius / b.weight)
                                       : std::numeric_limits<double>::infinity();
    if (b.thinness > 0) octant.thinnest = parent.half / static_cast<double>(b.thinness);
    octant.local_radius = std::min(octant.local_radius, most_over_thinnest * octant.thinnest);
  }
  return result;
}

CubeView Divider::child(const CubeView& parent, int octant) const {
  const Vec3d center = octant_center(parent.center, parent.half, octant);
  const double half = parent.half / 2;
  return {center, half,
          KeptSurroundings(refined(coarse_, tree_, &parent.sources, octant, center, half, largest_coarse_group))};
}

}  // namespace marrow
