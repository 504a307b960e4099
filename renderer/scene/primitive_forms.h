// The skeletons that a blend sums, and what each of them may say.
#pragma once

#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/form.h"
#include "renderer/scene/table.h"

namespace marrow {

Form<SkeletonModel> skeleton_model();
/// The projection angle as a number of radians in [-1, pi/2].
Form<double> primitive_alpha();
/// One radius, or a list of `min` to `max` of them.
Form<std::vector<double>> radii(std::size_t min, std::size_t max, const std::string& words);

Form<Primitive> point_form();
Form<Primitive> segment_form();
Form<Primitive> triangle_form();
Form<Primitive> circle_form();
Form<Primitive> arc_form();

std::vector<const TableInfo*> primitive_tables();

}  // namespace marrow
