// Certified ray tracing of a tree of general nodes.
//
// Each member of a crisp union is traced by itself: the nearest hit of all is that of the union, seen from outside; of
// up to 1024 members, crossings inside another one are passed, so that it is from inside too, and cells inside another
// one are dropped. For each of them there is an octree over the box that can hold its surface: parts that bounds prove
// to be all outside or all inside are dropped, the others are divided, when rays come, until the surface in them is one
// sheet to all appearances. Each cell keeps what is left of the tree there (localized()). Of a union of very many, a
// member without operators is one cell. Along a ray, enclosures of the field and of its slope tell intervals without a
// root from those with exactly one; what remains is divided around its middle.   [interval Newton isolation: Moore
// 1966; pruned programs: Keeter 2020]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "field/base/result.h"
#include "field/math/ray.h"
#include "field/trace/blend_tracer.h"
#include "field/trace/general/tree_cell.h"
#include "field/tree/field_tree.h"

namespace marrow {

struct TreeHit {
  double t = 0;
  const TreeCell* cell = nullptr;  ///< that it was found in, if any
};

/// Safe to use from many threads.
class TreeTracer {
 public:
  /// Of the surface `within` a box, but where it is that of a blend which is lent. Errors: a field whose surface is
  /// not bounded there, or may be anywhere.
  static Result<TreeTracer> make(FieldTree, const Box3& within = everywhere, TreeDivision division = {});
  static constexpr Box3 everywhere{{-Box3::inf, -Box3::inf, -Box3::inf}, {Box3::inf, Box3::inf, Box3::inf}};

  std::size_t cell_count() const { return cells_.size(); }
  const Box3& cell_box(std::size_t cell) const { return cells_[cell].box; }

  /// The first crossing of the surface, from either side, inside a cell with t in [ray.t_min, ray.t_max]; t does not
  /// depend on ray.t_max. With `any`, any crossing. `undecided` of the log: a gap of 2^-34 of the body, without a
  /// change of side from end to end, in which no bound excludes a touch.
  std::optional<TreeHit> first_hit(std::size_t cell, const Ray&, bool any, CellLog&) const;
  /// `along`: of the ray that met it. Where a field jumps, or members of a union meet, further rays may have to start
  /// beside it instead of in the direction of the normal.
  SurfacePoint surface_at(std::size_t cell, const Vec3d& position, const Vec3d& along = {}) const;

  const FieldTree& tree() const { return tree_; }
  /// Null: none.
  const BlendInTree* lent() const { return division_->lent.get(); }
  /// Of the leaf that counts most at a hit; invalid: the object's own.
  MaterialId material_at(std::size_t cell, const Vec3d& position) const;
  /// Bounds of the surface.
  const Box3& bounds() const { return bounds_; }
  std::size_t bytes() const;

 private:
  struct Cell {
    Box3 box;
    std::uint32_t member;  ///< record of the whole tree
    const TreeCell* part;  ///< equal to the member in the box and a little beyond; null: the member itself
  };
  TreeTracer(FieldTree tree, TreeDivision division)
      : tree_(std::move(tree)),
        division_(std::make_unique<const TreeDivision>(std::move(division))),
        only_material_(only_material(tree_)) {}
  void divide(const UnionMember&);
  double error_at(const Cell&) const;
  UnitVec3 normal_at_joint(const Cell&, const Vec3d& position, const Vec3d& along, const UnitVec3& of_member) const;
  static double shortest_step(const Cell&);
  std::optional<Vec3d> outside_by_slope(const Cell&, const Vec3d& position, const UnitVec3& normal, double slope) const;
  std::optional<Vec3d> outside_along(const Cell&, const Vec3d& position, const Vec3d& direction, double likely) const;
  bool is_inside_another(std::uint32_t member, const Box3&) const;
  bool is_covered(std::uint32_t member, const Ray&, double t) const;
  double covered_until(std::uint32_t member, const Ray&, double t, double& stride) const;
  bool is_joint(std::uint32_t member, const Ray&, double t) const;
  template <Number X>
  X largest_of_others(std::uint32_t member, const Vec3<X>& p) const;
  template <Number X>
  X field_near(const Cell&, const Vec3d& p, const Vec3<X>& there) const;
  Interval field_enclosed(const Cell&, const Vec3d& p) const;
  template <class Use>
  auto with_field_near(const Cell&, const Vec3d& p, const Use&) const;

  FieldTree tree_;
  std::unique_ptr<const TreeDivision> division_;  ///< where it stays for the cells
  std::optional<MaterialId> only_material_;       ///< of all leaves
  Box3 bounds_;
  std::vector<UnionMember> members_;  ///< of a union, where there are few enough to ask all of them at a crossing
  std::vector<std::unique_ptr<const TreeCell>> roots_;
  std::vector<Cell> cells_;
};

}  // namespace marrow
