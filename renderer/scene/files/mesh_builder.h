// What readers of meshes share: positions, faces that may name them before they come, and triangles of both.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "field/base/result.h"
#include "renderer/scene/files/text_scan.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

class MeshBuilder {
 public:
  /// Text and name must outlive it. `counted_from`: the number of the first vertex in this format, 0 or 1.
  MeshBuilder(std::string_view text, const std::string& name, int counted_from)
      : problems_(text, name), counted_from_(counted_from) {}

  FileProblems& problems() { return problems_; }
  std::size_t vertex_count() const { return positions_.size(); }
  /// Places are those in the text, or null.
  void add_vertex(const Vec3d&, const char* place);
  /// A corner of the next face: a vertex by its index from 0, whether it came already or not.
  void add_corner(std::uint32_t vertex, const char* place);
  /// All corners since the last one are a face. Fewer than three are points and lines, and are left out.
  void end_face(const char* place);
  /// Or all mistakes.
  Result<MeshShape> finish() &&;

 private:
  struct Ahead {
    std::uint32_t vertex;
    const char* place;
  };
  struct Face {
    std::size_t end;  ///< in the list of corners; it begins where the one before ends
    const char* place;
  };
  void split(MeshShape&);

  FileProblems problems_;
  int counted_from_;
  std::vector<Vec3d> positions_;
  std::vector<std::uint32_t> corners_;
  std::vector<Face> faces_;
  std::vector<Ahead> ahead_;  // corners that had no vertex when they came
};

}  // namespace marrow
