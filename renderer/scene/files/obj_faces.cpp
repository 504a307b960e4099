#include "renderer/scene/files/obj_faces.h"

#include <cstdint>
#include <limits>

#include <fmt/core.h>

#include "renderer/scene/files/mesh_builder.h"
#include "renderer/scene/files/obj_statements.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

// A vertex with mistakes is counted, so that others keep their numbers.
void read_vertex(std::string_view words, const char* statement, MeshBuilder& mesh) {
  Vec3d at{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string_view word = next_word(words);
    if (const auto number = finite_number(word)) at[axis] = *number;
    else
      mesh.problems().complain(word,
                               word.empty() ? fmt::format("the vertex ends after {} numbers, it needs 3", axis)
                                            : quoted_word(word) + " is not a finite number",
                               "a vertex is: v x y z");
    if (word.empty()) break;
  }
  mesh.add_vertex(at, statement);
}

}  // namespace

Result<MeshShape> read_obj_faces(std::string_view text, const std::string& name) {
  constexpr std::size_t most_vertices = std::numeric_limits<std::int32_t>::max();
  MeshBuilder mesh(text, name, 1);
  FileProblems& problems = mesh.problems();
  ObjLines lines(text);
  std::size_t corners = 0;
  for (ObjLine line{}; !problems.is_full() && lines.next(line);) {
    const char* const statement = line.keyword.data();
    if (line.keyword == "v" && line.is_first) read_vertex(line.words, statement, mesh);
    if (line.keyword != "f") continue;
    if (line.is_first) corners = 0;
    for (std::string_view word = next_word(line.words); !word.empty(); word = next_word(line.words), ++corners)
      if (const auto vertex = obj_index(word, mesh.vertex_count(), most_vertices, problems))
        mesh.add_corner(static_cast<std::uint32_t>(*vertex), word.data());
    if (!line.is_last) continue;
    if (corners < 3) problems.complain(statement, "a face needs three vertices");
    mesh.end_face(statement);
  }
  return std::move(mesh).finish();
}

}  // namespace marrow
