// The same surface by simpler operators; internal to program/.
#pragma once

#include <optional>

#include "field/description/field_node.h"

namespace marrow {

/// A description of the same surface with crisp set operations for sharp ones. These differ in the field around the
/// surface alone (field/tree/nodes/sharp_csg.h), which nobody sees but operators that mix fields and angles that follow
/// one: below those sharp operations stay. Nothing where no operation is replaced.
/// Precondition: the description is valid. Nodes keep their numbers.
std::optional<FieldDescription> crisp_surface(const FieldDescription&);

}  // namespace marrow
