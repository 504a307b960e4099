// The field nodes of the format: `point:`, `blend:`, `transform:` …
#pragma once

#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/form.h"
#include "renderer/scene/table.h"

namespace marrow {

/// Adds the node that the value describes, after its children, to reader.field.
Form<FieldNodeId> field_node();

/// A whole field with its root. False after reporting mistakes.
bool read_field(const Value&, Reader&, FieldDescription&);
Form<FieldDescription> field_tree();

std::vector<const TableInfo*> field_tables();
std::vector<const AlternativesInfo*> field_alternatives();

}  // namespace marrow
