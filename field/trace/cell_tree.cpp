#include "field/trace/cell_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "field/math/elementary.h"

namespace marrow {

Vec3d octant_center(const Vec3d& center, double half, int octant) {
  const double q = half / 2;
  return {center.x + (octant & 1 ? q : -q), center.y + (octant & 2 ? q : -q), center.z + (octant & 4 ? q : -q)};
}

namespace {

enum class Side { Outside, Inside, Mixed };

// Near pieces of one cube in its coordinates, as the kernel reads them: curves, then points.
struct alignas(64) PieceGroup {
  float from[3][lanes], along[3][lanes], inverse_length2[lanes], mass[lanes], low_mass[lanes], radius[lanes],
      length[lanes];
};
static_assert(sizeof(PieceGroup) == floats_per_piece_group * sizeof(float));

class PieceGroups {
 public:
  PieceGroups(std::span<const Piece> pieces, std::span<const PieceIndex> near, const Vec3d& center, double half,
              int degree)
      : center_(center), scale_(1 / half), degree_(degree) {
    for (const bool points : {false, true}) {
      int count = 0;
      for (const PieceIndex i : near)
        if (pieces[i].is_point() == points) add(pieces[i], count++);
      (points ? point_groups_ : curve_groups_) = (count + lanes - 1) / lanes;
    }
  }
  const float* data() const { return groups_.empty() ? nullptr : groups_.front().from[0]; }
  int curve_groups() const { return curve_groups_; }
  int point_groups() const { return point_groups_; }

 private:
  // Unused lanes stay at mass 0, far away.
  void add(const Piece& p, int count) {
    const int lane = count % lanes;
    if (lane == 0) {
      groups_.push_back({});
      for (auto& axis : groups_.back().from) std::fill(axis, axis + lanes, 1e3F);
    }
    PieceGroup& g = groups_.back();
    const Vec3d from = (p.from - center_) * scale_, along = (p.to - p.from) * scale_;
    const int exponent = degree_ - (p.is_point() ? 1 : 0);
    const double mass = p.mass * integer_power(scale_, exponent);
    const double taper = std::min(p.radius_from, p.radius_to) / p.radius, length2 = length_squared(along);
    for (std::size_t k = 0; k < 3; ++k) {
      g.from[k][lane] = static_cast<float>(from[k]);
      g.along[k][lane] = static_cast<float>(along[k]);
    }
    g.inverse_length2[lane] = static_cast<float>(length2 > 0 ? 1 / length2 : 0);
    g.mass[lane] = static_cast<float>(mass);
    g.low_mass[lane] = static_cast<float>(mass * integer_power(taper, degree_ - 1));
    g.radius[lane] = static_cast<float>(p.radius * scale_);
    g.length[lane] = static_cast<float>(p.length * scale_);
  }

  Vec3d center_;
  double scale_;
  int degree_, curve_groups_ = 0, point_groups_ = 0;
  std::vector<PieceGroup> groups_;
};

class TreeBuilder {
 public:
  TreeBuilder(std::span<const Piece> pieces, const NearFar& near_far, const IsoCurve& iso, const BlockKernels& kernels,
              int degree, const CellTreeSettings& settings)
      : pieces_(pieces), near_far_(near_far), iso_(iso), kernels_(kernels), degree_(degree), settings_(settings) {}

  CellTree::Branch root() const;

  struct Expansion {
    std::uint8_t cells = 0;  // octants that are cells
    std::vector<CellTree::Branch> branches;
  };
  Expansion expand(const CellTree::Branch&, int level) const;

 private:
  Side side(const OctantBounds&, const FarField::Bounds&) const;
  double influence() const;

  std::span<const Piece> pieces_;
  const NearFar& near_far_;
  const IsoCurve& iso_;
  const BlockKernels& kernels_;
  int degree_;
  CellTreeSettings settings_;
};

Side TreeBuilder::side(const OctantBounds& near, const FarField::Bounds& far) const {
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
  const PieceGroups pieces(pieces_, parent.near, parent.center, parent.half, degree_);
  std::array<OctantBounds, 8> octants;
  kernels_.octant_bounds(pieces.data(), pieces.curve_groups(), pieces.point_groups(), degree_, octants.data());
  const FarField::Bounds parent_far = parent.far.bounds();
  const double half = parent.half / 2;
  for (int octant = 0; octant < 8; ++octant) {
    const OctantBounds& near = octants[static_cast<std::size_t>(octant)];
    if (side(near, parent_far) != Side::Mixed) continue;
    FarField far = parent.far.of_child(octant);
    if (side(near, far.bounds()) != Side::Mixed) continue;
    const double local_radius = parent.half * near.weighted_radius / near.weight;
    if (half <= settings_.cell_size * local_radius || level >= settings_.deepest_level) {
      out.cells = static_cast<std::uint8_t>(out.cells | (1U << octant));
      continue;
    }
    CellTree::Branch branch{
        .center = octant_center(parent.center, parent.half, octant), .half = half, .near = {}, .far = far};
    branch.near = near_far_.split(pieces_, parent.near, branch.center, half, branch.far);
    out.branches.push_back(std::move(branch));
  }
  return out;
}

}  // namespace

// Level by level: the branches of a level are expanded in parallel, and gathered in their order.
CellTree::CellTree(std::span<const Piece> pieces, const NearFar& near_far, const IsoCurve& iso,
                   const BlockKernels& kernels, int degree, const CellTreeSettings& settings) {
  if (pieces.empty()) return;
  const TreeBuilder builder(pieces, near_far, iso, kernels, degree, settings);
  std::vector<Branch> level{builder.root()};
  for (int depth = 1; !level.empty(); ++depth) {
    std::vector<TreeBuilder::Expansion> expansions(level.size());
    tbb::parallel_for(std::size_t{0}, level.size(),
                      [&](std::size_t i) { expansions[i] = builder.expand(level[i], depth); });
    std::vector<Branch> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (int octant = 0; octant < 8; ++octant)
        if (expansions[i].cells >> octant & 1)
          cells_.push_back({octant_center(level[i].center, level[i].half, octant), level[i].half / 2,
                            static_cast<std::uint32_t>(branches_.size()), static_cast<std::uint8_t>(octant)});
      if (expansions[i].cells != 0) branches_.push_back(std::move(level[i]));
      std::move(expansions[i].branches.begin(), expansions[i].branches.end(), std::back_inserter(next));
    }
    level = std::move(next);
  }
}

std::size_t CellTree::bytes() const {
  std::size_t sum = cells_.capacity() * sizeof(Cell) + branches_.capacity() * sizeof(Branch);
  for (const Branch& b : branches_) sum += b.near.capacity() * sizeof(PieceIndex);
  return sum;
}

}  // namespace marrow
