// Meshes in Wavefront OBJ: `v` positions joined by `f`.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

/// The faces of an OBJ file; lines, points, normals and the rest are left out. Indices as in read_obj_lines(). Errors:
/// every statement that is wrong, up to 20; vertices that do not exist or lie beyond 1e15; no face.
Result<MeshShape> read_obj_faces(std::string_view text, const std::string& name);

}  // namespace marrow
