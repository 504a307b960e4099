// The general nodes of field/tree in the format, made from what each kind tells about itself.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/form.h"
#include "renderer/scene/table.h"

namespace marrow {

/// Name and form of every kind of node; a form adds the node, after its children, to reader.field.
std::vector<std::pair<std::string, Form<FieldNodeId>>> general_node_forms();
std::vector<const TableInfo*> general_node_tables();
std::vector<const AlternativesInfo*> general_node_alternatives();

}  // namespace marrow
