// Lights of the format.
#pragma once

#include <vector>

#include "renderer/scene/scene_description.h"
#include "renderer/scene/table.h"

namespace marrow {

Form<LightDescription> light();

std::vector<const TableInfo*> light_tables();
const AlternativesInfo& light_alternatives();

}  // namespace marrow
