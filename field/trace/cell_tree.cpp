#include "field/trace/cell_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "field/math/elementary.h"

namespace marrow {

Vec3d octant_center(const Vec3d& center, double half, int octant) {
  const double q = half / 2;
  return {center.x + (octant & 1 ? q : -q), center.y + (octant & 2 ? q : -q), center.z + (octant & 4 ? q : -q)};
}

namespace {

enum class Side { Outside, Inside, Mixed };

// Bounds of f and |grad_S f| over a ball, from the pieces near it.
struct BallSums {
  double f_high = 0, gradient_high = 0, f_low = 0;
  double local_radius = 0;  // of the pieces, weighted by their fields at the centre
  bool touches = false;     // a piece comes into the ball: no upper bound
};

class TreeBuilder {
 public:
  TreeBuilder(std::span<const Piece> pieces, const NearFar& near_far, const IsoCurve& iso, int degree,
              const CellTreeSettings& settings)
      : pieces_(pieces), near_far_(near_far), iso_(iso), degree_(degree), settings_(settings) {}

  CellTree::Branch root() const;

  struct Expansion {
    std::uint8_t cells = 0;  // octants that are cells
    std::vector<CellTree::Branch> branches;
  };
  Expansion expand(const CellTree::Branch&, int level) const;

 private:
  BallSums sums(std::span<const PieceIndex>, const Vec3d& center, double radius) const;
  Side side(const BallSums&, const FarField::Bounds&) const;
  double influence() const;

  std::span<const Piece> pieces_;
  const NearFar& near_far_;
  const IsoCurve& iso_;
  int degree_;
  CellTreeSettings settings_;
};

// Every source at distance d from all points of the ball at least; sums of norms bound the norm of the sum.
BallSums TreeBuilder::sums(std::span<const PieceIndex> near, const Vec3d& center, double radius) const {
  BallSums s;
  double weight_sum = 0, weighted_radius = 0;
  for (const PieceIndex i : near) {
    const Piece& p = pieces_[i];
    const int m = degree_ - (p.is_point() ? 1 : 0);
    const double d = distance(p, center), nearest = d - radius;
    if (nearest > 1e-6 * radius) {
      const double inverse = 1 / nearest, field = p.mass * integer_power(inverse, m);
      s.f_high += field;
      s.gradient_high += m * field * p.radius * inverse;
    } else {
      s.touches = true;
    }
    const double taper = std::min(p.radius_from, p.radius_to) / p.radius;
    const double low = p.mass * integer_power(taper, degree_ - 1) / integer_power(d + p.length + radius, m);
    s.f_low += low;
    const double weight = p.mass / integer_power(std::max(d, 0.5 * p.radius), m);
    weight_sum += weight;
    weighted_radius += weight * p.radius;
  }
  if (weight_sum > 0) s.local_radius = weighted_radius / weight_sum;
  return s;
}

Side TreeBuilder::side(const BallSums& near, const FarField::Bounds& far) const {
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
double TreeBuilder::influence() const {
  double curve_mass = 0, point_mass = 0, radius = 0;
  for (const Piece& p : pieces_) {
    (p.is_point() ? point_mass : curve_mass) += p.mass;
    radius = std::max(radius, p.radius);
  }
  const auto outside = [&](double d) {
    const double curves = curve_mass / integer_power(d, degree_), points = point_mass / integer_power(d, degree_ - 1);
    return iso_.outside(0, curves + points, (degree_ * curves + (degree_ - 1) * points) * radius / d);
  };
  double d = radius;
  while (!outside(d) && d < 1e6 * radius) d *= 1.25;
  return d;
}

CellTree::Branch TreeBuilder::root() const {
  Box3 box;
  for (const Piece& p : pieces_) box.include(p.box());
  CellTree::Branch root;
  // On a coarse binary grid, so that the planes of all cells are exact numbers and neighbours share them.
  const double needed = max_component(box.size()) / 2 + influence();
  const double grid = std::ldexp(1.0, std::ilogb(needed) - 10);
  root.half = std::ceil(needed / grid + 1) * grid;
  for (std::size_t i = 0; i < 3; ++i) root.center[i] = std::floor(box.center()[i] / grid + 0.5) * grid;
  root.near.resize(pieces_.size());
  std::iota(root.near.begin(), root.near.end(), PieceIndex{0});
  return root;
}

TreeBuilder::Expansion TreeBuilder::expand(const CellTree::Branch& parent, int level) const {
  Expansion out;
  const double half = parent.half / 2, radius = half * std::sqrt(3.0) * (1 + 1e-9);
  const FarField::Bounds parent_far = parent.far.bounds();
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3d center = octant_center(parent.center, parent.half, octant);
    const BallSums near = sums(parent.near, center, radius);
    if (side(near, parent_far) != Side::Mixed) continue;
    FarField far = parent.far.of_child(octant);
    if (side(near, far.bounds()) != Side::Mixed) continue;
    if (half <= settings_.cell_size * near.local_radius || level >= settings_.deepest_level) {
      out.cells = static_cast<std::uint8_t>(out.cells | (1U << octant));
      continue;
    }
    CellTree::Branch branch{.center = center, .half = half, .near = {}, .far = far};
    branch.near = near_far_.split(pieces_, parent.near, center, half, branch.far);
    out.branches.push_back(std::move(branch));
  }
  return out;
}

}  // namespace

// Level by level: the branches of a level are expanded in parallel, and gathered in their order.
CellTree::CellTree(std::span<const Piece> pieces, const NearFar& near_far, const IsoCurve& iso, int degree,
                   const CellTreeSettings& settings) {
  if (pieces.empty()) return;
  const TreeBuilder builder(pieces, near_far, iso, degree, settings);
  std::vector<Branch> level{builder.root()};
  for (int depth = 1; !level.empty(); ++depth) {
    std::vector<TreeBuilder::Expansion> expansions(level.size());
    tbb::parallel_for(std::size_t{0}, level.size(),
                      [&](std::size_t i) { expansions[i] = builder.expand(level[i], depth); });
    std::vector<Branch> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (int octant = 0; octant < 8; ++octant)
        if (expansions[i].cells >> octant & 1)
          cells_.push_back({static_cast<std::uint32_t>(branches_.size()), static_cast<std::uint8_t>(octant)});
      if (expansions[i].cells != 0) branches_.push_back(std::move(level[i]));
      std::move(expansions[i].branches.begin(), expansions[i].branches.end(), std::back_inserter(next));
    }
    level = std::move(next);
  }
}

Vec3d CellTree::center(const Cell& c) const {
  const Branch& b = branches_[c.branch];
  return octant_center(b.center, b.half, c.octant);
}

Box3 CellTree::box(const Cell& c) const {
  const Vec3d p = center(c);
  const double h = half(c);
  return {p - Vec3d{h, h, h}, p + Vec3d{h, h, h}};
}

std::size_t CellTree::bytes() const {
  std::size_t sum = cells_.capacity() * sizeof(Cell) + branches_.capacity() * sizeof(Branch);
  for (const Branch& b : branches_) sum += b.near.capacity() * sizeof(PieceIndex);
  return sum;
}

}  // namespace marrow
