// Triangle meshes for stages and props.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

/// OBJ or PLY (ascii or binary), as the ending of `name` says. Polygons are split into triangles; points and lines
/// are left out; positions have single precision. Errors: unknown ending, what is no mesh, no triangle, positions
/// that are not finite.
Result<MeshShape> read_mesh(std::string_view bytes, const std::string& name);

}  // namespace marrow
