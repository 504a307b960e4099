// On which side of a solid under crisp or sharp set operations places are, and where surface of its operands is its
// own.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "field/math/box3.h"
#include "field/math/ray.h"
#include "field/math/side.h"
#include "field/tree/field_tree.h"
#include "field/tree/set_expression.h"
#include "renderer/geometry/operand_solid.h"

namespace marrow {

/// Holds the operands. Safe to use from many threads.
class BooleanSides {
 public:
  /// As BooleanSolid::make.
  BooleanSides(FieldTree whole, const Box3& bounds, SetExpression, std::vector<std::unique_ptr<OperandSolid>>);

  const FieldTree& whole() const { return whole_; }
  const Box3& bounds() const { return bounds_; }
  const SetExpression& expression() const { return expression_; }
  const std::vector<std::unique_ptr<OperandSolid>>& operands() const { return operands_; }

  /// The field of the whole.
  double value(const Vec3d&) const;
  FieldSample sample(const Vec3d&) const;

  /// Whether surface of an operand in a box is that of the whole; nothing where it is so in places, or not known.
  std::optional<bool> counts_in(std::size_t operand, const Box3&) const;
  /// The same of the crossing of an operand at t.
  bool counts_at(std::size_t operand, const Ray&, double t) const;

  /// Unknown where fields, and places by what `rounding` they have, are off by more than it is from the surface.
  Side side_of_operand(std::size_t operand, const Vec3d&, double rounding) const;
  Side side_of_whole(const Vec3d&, double rounding) const;
  /// Of the whole, as Solid::clear_side.
  Side clear_side(const Vec3d&) const;

  /// Whether what is outside an operand is outside the whole.
  bool is_needed_everywhere(std::size_t operand) const { return needed_[operand]; }
  bool is_needed(std::size_t operand, const Vec3d& place) const;

 private:
  bool is_entered_later(std::size_t operand, const Ray&, double t) const;
  Side side_along(const Ray&, double t, double way) const;
  Side side_if_outside(std::size_t operand, const Box3& where) const;

  FieldTree whole_;
  Box3 bounds_;
  SetExpression expression_;
  std::vector<std::unique_ptr<OperandSolid>> operands_;
  std::vector<bool> needed_;
};

}  // namespace marrow
