// Polylines, subdivision curves and graphs of them.
#pragma once

#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/form.h"
#include "renderer/scene/table.h"

namespace marrow {

Form<Primitive> polyline_form();
/// A subdivision curve or, with `branches`, a graph of them.
Form<Primitive> curve_form();
/// The masks of subdivision: `chaikin` or `cubic`.
Form<Subdivision> subdivision_name();

std::vector<const TableInfo*> curve_tables();

}  // namespace marrow
