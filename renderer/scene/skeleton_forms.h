// Skeletons from files.
#pragma once

#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/form.h"
#include "renderer/scene/table.h"

namespace marrow {

/// Reads the file that it names. A file with the same options is read once, however often it is placed.
Form<Primitive> skeleton_form();

std::vector<const TableInfo*> skeleton_tables();

}  // namespace marrow
