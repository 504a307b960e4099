// Materials of the format.
#pragma once

#include <vector>

#include "renderer/scene/scene_description.h"
#include "renderer/scene/table.h"

namespace marrow {

Form<MaterialDescription> material();

/// All materials by name.
Form<std::vector<NamedMaterial>> material_list();

std::vector<const TableInfo*> material_tables();
const AlternativesInfo& material_alternatives();

}  // namespace marrow
