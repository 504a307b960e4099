// Scenes that are hard to trace, made from a number.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "renderer/geometry/embree_surfaces.h"
#include "tests/stress/way_proof.h"
#include "tests/trace/oracle.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {

inline constexpr std::array kind_names{
    "skeletons", "thin feature", "nearly touching", "ring",  "loop",  "degenerate", "ratios",      "far away", "angles",
    "strands",   "star",         "bundle",          "jumps", "graph", "lattice",    "high degree", "touching", "cones",
    "hair",      "stubs",        "hollow",          "dust"};

/// Of them, those with one angle come first, then those of varying angles, in scenes from the first of these numbers
/// on, then odd ones, as nobody would model them, from the second on.
inline constexpr std::size_t single_angle_kinds = 8, varied_kinds = 2;
inline constexpr std::uint64_t first_varied_scene = 1'000'000'000, first_odd_scene = 2'000'000'000;

/// One blend, the surfaces that are tested, and the oracle that judges them.
class StressScene {
 public:
  /// The kind is `number` modulo the number of kinds of its sort; everything else is drawn from a generator with this
  /// seed.
  explicit StressScene(std::uint64_t number);

  const std::string& name() const { return name_; }
  std::size_t kind() const { return kind_; }  ///< index of kind_names
  bool has_varied_angle() const { return has_varied_angle(kind_); }
  static bool has_varied_angle(std::size_t kind) {
    return kind >= single_angle_kinds && kind < single_angle_kinds + varied_kinds;
  }
  bool is_odd() const { return is_odd(kind_); }
  static bool is_odd(std::size_t kind) { return kind >= single_angle_kinds + varied_kinds; }
  /// A stretch inside counts as missed if the corrected field gets this far above 1 on it: the traced field may differ
  /// by 1e-5 of the radius, times the slope of some n - 1 over a radius.
  static constexpr double grazing_excess() { return 1e-5; }
  const BlendField& blend() const { return blend_; }
  const EmbreeSurfaces& surfaces() const { return *surfaces_; }
  const Oracle& oracle() const { return *oracle_; }
  const WayProof& proof() const { return *proof_; }
  double size() const { return size_; }  ///< half of the scene's extent, about
  const Vec3d& center() const { return center_; }
  const Vec3d& focus() const { return focus_; }  ///< where it is hardest
  double focus_size() const { return focus_size_; }
  /// Of the whole division of space: no surface is outside.
  const Box3& cells() const { return cells_; }
  Box3 random_cell(Random&) const;

 private:
  void build(std::uint64_t number);

  std::size_t kind_ = 0;
  std::string name_;
  BlendField blend_;
  double size_ = 1.6, focus_size_ = 0.5;
  Vec3d center_{}, focus_{};
  std::unique_ptr<EmbreeSurfaces> surfaces_;
  std::unique_ptr<Oracle> oracle_;
  std::unique_ptr<WayProof> proof_;
  Box3 cells_;
};

}  // namespace marrow::test
