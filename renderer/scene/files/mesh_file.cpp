// The only door to Assimp.
#include "renderer/scene/files/mesh_file.h"

#include <algorithm>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "renderer/scene/files/ascii.h"

namespace marrow {
namespace {

// Assimp never ends on a PLY file whose header does not.
bool header_ends(std::string_view bytes, const std::string& ending) {
  return ending != ".ply" || bytes.find("end_header") != std::string_view::npos;
}

// Everything but positions and triangles goes, so that equal corners become one.
void keep_only_triangles(Assimp::Importer& importer) {
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                          aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                          aiComponent_TEXTURES | aiComponent_MATERIALS);
}

void append(MeshShape& shape, const aiMesh& mesh) {
  const auto base = static_cast<std::uint32_t>(shape.positions.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i)
    shape.positions.push_back({mesh.mVertices[i].x, mesh.mVertices[i].y, mesh.mVertices[i].z});
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    // A polygon becomes a fan; points and lines become nothing. (Assimp's own triangulation ends the program on faces
    // that a cut file leaves incomplete.)
    for (unsigned k = 2; k < face.mNumIndices; ++k)
      if (const unsigned* v = face.mIndices; std::max({v[0], v[k - 1], v[k]}) < mesh.mNumVertices)
        shape.triangles.push_back({base + v[0], base + v[k - 1], base + v[k]});
  }
}

}  // namespace

Result<MeshShape> read_mesh(std::string_view bytes, const std::string& name) {
  const std::string ending = ending_of(name);
  if (ending != ".obj" && ending != ".ply") return failure("`" + name + "` is neither .obj nor .ply", name);
  if (bytes.empty()) return failure("the file is empty", name);
  if (!header_ends(bytes, ending)) return failure("not a mesh: the header of the PLY file has no end", name);
  Assimp::Importer importer;
  keep_only_triangles(importer);
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(), aiProcess_RemoveComponent | aiProcess_JoinIdenticalVertices, ending.c_str() + 1);
  if (!scene) return failure(std::string("not a mesh: ") + importer.GetErrorString(), name);
  MeshShape shape;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(shape, *scene->mMeshes[i]);
  if (shape.triangles.empty()) return failure("the mesh has no triangle", name);
  const bool finite =
      std::all_of(shape.positions.begin(), shape.positions.end(), [](const Vec3d& p) { return is_finite(p); });
  if (!finite) return failure("the mesh has a position that is not finite", name);
  return shape;
}

}  // namespace marrow
