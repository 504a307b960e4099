// A tree of general nodes as a solid: its elements are the cells of its tracer.
#pragma once

#include <memory>
#include <utility>

#include "field/trace/general/tree_tracer.h"
#include "renderer/geometry/operand_solid.h"

namespace marrow {

class TreeSolid final : public OperandSolid {
 public:
  /// As TreeTracer::make().
  static Result<std::unique_ptr<TreeSolid>> make(FieldTree, MaterialId of_object,
                                                 const Box3& within = TreeTracer::everywhere, TreeDivision = {});

  std::size_t element_count() const override { return tracer_.cell_count(); }
  Box3 element_box(std::size_t element) const override { return tracer_.cell_box(element); }
  Box3 extent() const override { return tracer_.bounds(); }
  Box3 reach() const override { return tracer_.bounds(); }
  FieldSample sample(const Vec3d&) const override;
  double value(const Vec3d&) const override;
  std::optional<double> hit(std::size_t, const Ray&, bool any, ElementLog&) const override;
  void describe(std::span<const HitToDescribe>) const override;
  std::optional<double> crossing(const SolidPart&, const Ray&, const CrossingFilter&, ElementLog&) const override;
  Side side_of(const Box3&) const override;
  double field_error() const override;
  std::optional<Vec3d> start_inside(const HitToDescribe&) const override;
  /// Without those of a blend that is lent.
  std::size_t primitive_count() const override;
  std::size_t bytes() const override { return tracer_.bytes(); }

 private:
  TreeSolid(TreeTracer, MaterialId of_object);

  TreeTracer tracer_;
  MaterialId material_;
  bool holds_blends_;
};

}  // namespace marrow
