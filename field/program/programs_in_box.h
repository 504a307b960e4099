// Field programs in a part of space, summed in a fraction of the time where they have many skeletons.
#pragma once

#include <span>
#include <vector>

#include "field/math/box3.h"
#include "field/math/vec3.h"
#include "field/program/field_program.h"
#include "field/tree/field_tree.h"

namespace marrow {

/// The largest of some programs, as localized() to a box. Immutable.
class ProgramsInBox {
 public:
  /// In all of space, as they are. They must outlive what is made of them.
  explicit ProgramsInBox(std::span<const FieldProgram* const>);

  /// In a box inside this one. Parts and trees that are nowhere the largest there are gone.
  ProgramsInBox within(const Box3&) const;
  /// Value and gradient, no material: those of evaluate() of the largest program, to within what blends in boxes may be
  /// off (local_blend.h). 0 where there is nothing.
  FieldSample at(const Vec3d& p) const;

 private:
  ProgramsInBox() = default;
  std::vector<FieldTree> trees_;
};

/// How many primitives and nodes there are to be evaluated: a measure of what a sample takes.
std::size_t count_of_all(const FieldProgram&);

}  // namespace marrow
