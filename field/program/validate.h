// Checks the parameters of each node of a field description by themselves.
#pragma once

#include "field/base/diagnostics.h"
#include "field/description/field_node.h"

namespace marrow {

/// Everything wrong with single nodes: numbers out of range, lists of unequal length, children that do not stand
/// before their parent. Empty when compile() may walk the tree.
Diagnostics validate(const FieldDescription&);

}  // namespace marrow
