// Triangles as a solid. Intersected in double precision, so that pictures do not depend on the instruction set.
#pragma once

#include "renderer/geometry/solid.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

class MeshSolid final : public Solid {
 public:
  MeshSolid(const MeshShape&, MaterialId);

  std::size_t element_count() const override { return mesh_.triangles.size(); }
  Box3 element_box(std::size_t) const override;
  Box3 extent() const override;
  double smallest_detail() const override { return longest_side(extent()); }
  std::optional<double> hit(std::size_t, const Ray&, bool any, ElementLog&) const override;
  /// The normal is that of the triangle, on the side the ray comes from.
  void describe(std::span<const HitToDescribe>) const override;
  std::size_t primitive_count() const override { return element_count(); }
  std::size_t bytes() const override;

 private:
  std::array<Vec3d, 3> corners(std::size_t) const;
  MeshShape mesh_;
  MaterialId material_;
};

/// A point of a ray near the plane through `in_plane`, moved into it and then to the normal's side, by more than
/// rounding can have misplaced it there.
Vec3d lifted(const Vec3d& position, const Vec3d& in_plane, const UnitVec3& normal);

}  // namespace marrow
