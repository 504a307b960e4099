// Meshes in the Polygon File Format of Stanford (Turk 1994).
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

/// ASCII and binary of both byte orders. `x`, `y`, `z` of `vertex`, and of `face` the list `vertex_indices` (or
/// `vertex_index`), which counts from 0; all else is passed over. Errors: a header that is none; a file that ends
/// before all that it announces has come; vertices that do not exist, are not finite, or lie beyond 1e15; no face.
Result<MeshShape> read_ply(std::string_view bytes, const std::string& name);

}  // namespace marrow
