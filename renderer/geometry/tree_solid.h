// A tree of general nodes as a solid: its elements are the cells of its tracer.
#pragma once

#include <memory>
#include <utility>

#include "field/trace/general/tree_tracer.h"
#include "renderer/geometry/solid.h"

namespace marrow {

class TreeSolid final : public Solid {
 public:
  static Result<std::unique_ptr<TreeSolid>> make(FieldTree, MaterialId of_object);

  std::size_t element_count() const override { return tracer_.cell_count(); }
  Box3 element_box(std::size_t element) const override { return tracer_.cell_box(element); }
  Box3 extent() const override { return tracer_.bounds(); }
  Box3 reach() const override { return tracer_.bounds(); }
  FieldSample sample(const Vec3d&) const override;
  double value(const Vec3d&) const override;
  std::optional<double> hit(std::size_t, const Ray&, bool any, ElementLog&) const override;
  void describe(std::span<const HitToDescribe>) const override;
  std::size_t primitive_count() const override;
  std::size_t bytes() const override { return tracer_.bytes(); }

 private:
  TreeSolid(TreeTracer tracer, MaterialId of_object) : tracer_(std::move(tracer)), material_(of_object) {}

  TreeTracer tracer_;
  MaterialId material_;
};

}  // namespace marrow
