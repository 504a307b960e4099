// A solid that set operations can be done with.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "field/base/result.h"
#include "field/trace/blend_tracer.h"
#include "renderer/geometry/solid.h"

namespace marrow {

class OperandSolid : public Solid {
 public:
  /// The first crossing in a part, from either side, that counts; t as in hit().
  virtual std::optional<double> crossing(const SolidPart&, const Ray&, const CrossingFilter&, ElementLog&) const = 0;
  /// The box that the filter of crossings is asked for where a part is a cell, however much is known of it.
  virtual std::optional<Box3> cell_box(const SolidPart&) const { return {}; }
  /// Where all of a box is; unknown where that is not sooner told than the box divided.
  virtual Side side_of(const Box3&) const = 0;
  /// By how much the traced field may differ from value().
  virtual double field_error() const = 0;
  /// From a hit that has been described: a place inside, for rays that go on in what the solid is taken away from.
  virtual std::optional<Vec3d> start_inside(const HitToDescribe&) const = 0;
};

/// As one of them, with the errors of what it is made by.
template <class SolidType>
Result<std::unique_ptr<OperandSolid>> as_operand(Result<std::unique_ptr<SolidType>> solid) {
  if (!solid) return solid.why();
  return std::unique_ptr<OperandSolid>(std::move(*solid));
}

}  // namespace marrow
