// The scenes that Marrow and its peers are measured on.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "field/base/result.h"
#include "field/description/field_node.h"
#include "field/math/box3.h"
#include "field/math/vec3.h"

namespace marrow {

/// Skeletons, a camera that looks along -z over a square picture, and one sun. Coordinates and radii of those that have
/// names have five decimals, as in the text files by which the peers know them.
struct Workload {
  std::string name, about;
  Vec3d eye;
  double tan_half_fov = 0.2;
  Vec3d toward_light;  ///< unit length
  std::vector<SegmentSkeleton> segments;
  std::vector<PointSkeleton> points;
  /// When not empty: the primitives are one body, placed at each of these by a translation, each place a blend of its
  /// own.
  std::vector<Vec3d> places;

  /// Of all places together.
  std::size_t size() const { return (segments.size() + points.size()) * (places.empty() ? 1 : places.size()); }
  /// The same scene with every place's own copy of the primitives, as one blend.
  Workload flattened() const;
  /// Of all primitives with their radii.
  Box3 bounds() const;
  /// Surfaces::bounds() of the workload: the skeletons, and the largest radius around.
  Box3 extent() const;
  /// A place straight before the eye, along -z: on the plane z = 0 where that is at least 1 away, else at distance 1.
  Vec3d looked_at() const;
  double fov_deg() const;  ///< the whole angle of view
  /// Above 0, of all primitives.
  double thinnest_radius() const;
};

/// w1: 867 segments, a creature. w2: 10,000 segments in 500 curls. w3: 200 points.
Workload creature();
Workload hair();
Workload balls();

/// Curled strands of 20 segments in a ball, `count` segments in all. Lengths and radii shrink with 1 / sqrt(count), so
/// that the sum of the shadows, length times radius, stays the same.
Workload strands(std::size_t count);

/// Tufts of 1000 segments each, the same one placed by transforms, `count` segments in all; they shrink like strands.
Workload tufts(std::size_t count);

/// Errors: an unknown name; the hint lists those there are.
Result<Workload> workload_named(std::string_view name);
std::vector<std::string> workload_names();

/// A scene file for Marrow: the workload as one blend (`alpha: contact`) of white diffuse material under its sun, with
/// direct light only; placed ones as a union of uses of one blend. Large ones have their skeletons in an SWC file that
/// stands beside it under the given name; of others `skeleton` is empty.
struct SceneText {
  std::string scene, skeleton;
};
SceneText scene_text(const Workload&, int film_size, const std::string& skeleton_name);

/// Both, the SWC file with the scene's stem. When it fails there may be half of a file: for temporary files.
Status write_scene(const Workload&, int film_size, const std::filesystem::path& scene);

}  // namespace marrow
