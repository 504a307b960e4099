#include "renderer/scene/files/mesh_builder.h"

#include <span>
#include <utility>

#include <fmt/core.h>

#include "renderer/scene/files/polygon.h"
#include "renderer/scene/form.h"

namespace marrow {

void MeshBuilder::add_vertex(const Vec3d& at, const char* place) {
  if (!is_finite(at) || max_component(abs(at)) > largest_length)
    problems_.complain(
        place,
        fmt::format("vertex {} is not finite, or lies beyond 1e15", positions_.size() + std::size_t(counted_from_)),
        "nothing in a scene may be larger than 1e15");
  positions_.push_back(at);
}

void MeshBuilder::add_corner(std::uint32_t vertex, const char* place) {
  if (vertex >= positions_.size()) ahead_.push_back({vertex, place});
  corners_.push_back(vertex);
}

void MeshBuilder::end_face(const char* place) {
  const std::size_t begin = faces_.empty() ? 0 : faces_.back().end;
  if (corners_.size() - begin < 3) corners_.resize(begin);
  else faces_.push_back({corners_.size(), place});
}

void MeshBuilder::split(MeshShape& shape) {
  const std::span<const std::uint32_t> corners = corners_;
  std::size_t begin = 0;
  for (const Face& face : faces_) {
    const auto polygon = corners.subspan(begin, face.end - begin);
    if (!append_triangles(polygon, positions_, shape.triangles))
      problems_.complain(face.place, fmt::format("a face of {} corners that is not convex", polygon.size()),
                         fmt::format("cut it into faces of at most {}", most_concave_corners));
    begin = face.end;
  }
}

Result<MeshShape> MeshBuilder::finish() && {
  for (const Ahead& corner : ahead_)
    if (corner.vertex >= positions_.size())
      problems_.complain(corner.place,
                         fmt::format("there is no vertex {}: the file has {}",
                                     corner.vertex + std::uint64_t(counted_from_), positions_.size()),
                         fmt::format("vertices are counted from {}", counted_from_));
  if (faces_.empty() && problems_.none()) problems_.complain_of_file("the mesh has no face");
  MeshShape shape;
  if (problems_.none()) split(shape);
  if (!problems_.none()) return problems_.take();
  shape.positions = std::move(positions_);
  return shape;
}

}  // namespace marrow
