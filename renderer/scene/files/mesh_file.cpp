// The ending of a name tells its format.
#include "renderer/scene/files/mesh_file.h"

#include "renderer/scene/files/ascii.h"
#include "renderer/scene/files/obj_faces.h"
#include "renderer/scene/files/ply.h"

namespace marrow {

Result<MeshShape> read_mesh(std::string_view bytes, const std::string& name) {
  const std::string ending = ending_of(name);
  if (ending != ".obj" && ending != ".ply") return failure("`" + name + "` is neither .obj nor .ply", name);
  if (bytes.empty()) return failure("the file is empty", name);
  return ending == ".obj" ? read_obj_faces(bytes, name) : read_ply(bytes, name);
}

}  // namespace marrow
