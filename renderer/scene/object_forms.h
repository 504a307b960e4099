// Objects of the format: a name, a material and one shape.
#pragma once

#include <vector>

#include "renderer/scene/scene_description.h"
#include "renderer/scene/table.h"

namespace marrow {

/// The name is empty and the material invalid where the text leaves them out.
Form<ObjectDescription> object();

std::vector<const TableInfo*> object_tables();

}  // namespace marrow
