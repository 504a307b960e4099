// Nodes of a skeleton as they come from a file: scaled, checked, and at last with radii above 0.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/scene/files/skeleton_options.h"
#include "renderer/scene/files/text_scan.h"

namespace marrow {

/// Reports a number of a text that lies beyond 1e15 once it is in scene units.
void refuse_beyond(double in_scene_units, const char* place, FileProblems&);

/// Where the numbers of a node stand; all null for what has no place in a text.
struct NodePlaces {
  std::array<const char*, 3> at{};
  const char* radius = nullptr;
};

class NodeList {
 public:
  /// Of one file. A node takes some 40 bytes.
  static constexpr std::size_t max_nodes = 100'000'000;

  NodeList(const SkeletonOptions& options, FileProblems& problems) : options_(options), problems_(problems) {}

  void reserve(std::size_t nodes);
  std::size_t size() const { return graph_.positions.size(); }
  /// The index that the next node gets.
  std::int32_t next_index() const { return static_cast<std::int32_t>(size()); }

  /// A position and a radius as the file has them; 0 is a radius that is not known. Reports at its place a radius that
  /// is negative, each number that lies beyond 1e15 scene units, and one node too many.
  void add(const Vec3d& at, double radius, const NodePlaces& places = {});
  /// The same with its parent; a list has all parents or none.
  void add(const Vec3d& at, double radius, std::int32_t parent, const NodePlaces& places = {});
  /// A radius in scene units, which no option changes.
  void add_in_scene_units(const Vec3d& at_in_file, double radius, std::int32_t parent);

  /// For links that are known only at the end.
  std::vector<std::int32_t>& parents() { return graph_.parents; }

  /// The skeleton, once there were no problems. A radius of 0 becomes min_radius or, without one, the smallest radius
  /// above 0 of the file, with one warning; thinner nodes get min_radius. Reports a file without any radius.
  SkeletonFile finish() &&;

 private:
  void check_last(const NodePlaces&);

  const SkeletonOptions& options_;
  FileProblems& problems_;
  SkeletonGraph graph_;
};

}  // namespace marrow
