// How a scene gives the projection angle of a blend.
#pragma once

#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/form.h"
#include "renderer/scene/table.h"

namespace marrow {

/// A number of radians, a word, or a map: `{direction: …}`, `{attribute: …}`, `{field: …}`, `{contact: …}`.
Form<Alpha> alpha_form();
/// Two angles, [crossing, parallel].
Form<std::array<double, 2>> direction_bounds_form();
/// A map from names to numbers, or lists of numbers.
Form<std::vector<Attribute>> attributes_form();

std::vector<const TableInfo*> alpha_tables();

}  // namespace marrow
