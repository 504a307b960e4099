// Triangle meshes for stages and props.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

/// OBJ (obj_faces.h) or PLY (ply.h), as the ending of `name` says. Polygons are split into triangles (polygon.h);
/// points and lines are left out. Errors: unknown ending, and those of the formats.
Result<MeshShape> read_mesh(std::string_view bytes, const std::string& name);

}  // namespace marrow
