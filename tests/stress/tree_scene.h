// Scenes of general trees that are hard to trace, made from a number.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "field/tree/field_tree.h"
#include "renderer/geometry/embree_surfaces.h"
#include "tests/stress/tree_drafts.h"

namespace marrow::test {

/// One tree and the surfaces that are tested. Half of the scenes are some units large and stand at the origin; the
/// others are scaled by 1e-4 to 1e4, and some stand up to 1e5 of their sizes away. Half have cells as where hardly a
/// ray comes.
class TreeScene {
 public:
  /// The kind is `number` modulo the number of kinds; everything else is drawn from a generator with this seed.
  explicit TreeScene(std::uint64_t number);

  const std::string& name() const { return name_; }
  std::size_t kind() const { return kind_; }
  const FieldTree& tree() const { return tree_; }
  const EmbreeSurfaces& surfaces() const { return *surfaces_; }
  /// Where the tracer looks for surface; never empty.
  const Box3& cells() const { return cells_; }
  const Vec3d& center() const { return center_; }
  double size() const { return size_; }  ///< half of the extent of the cells
  /// By what share of the field sums may be off, and what is no error of theirs: of blends that have a tracer of their
  /// own 1e-5, which is its tolerance.
  double sum_error() const { return has_traced_blends(kind_) ? 1e-6 : 2e-7; }
  double noticed() const { return has_traced_blends(kind_) ? 1e-5 : 1e-6; }
  /// The same as a length: 2e-5 radii of what is thin in the scene. Fields may be steps.
  double noticed_beside() const { return has_traced_blends(kind_) ? 2e-5 * focus_size_ / focus_over_radius : 0; }
  double value(const Vec3d& p) const { return marrow::value(tree_, p); }

  /// The box of an element, or all.
  Box3 random_cell(Random&) const;
  /// One of the hardest places, exactly.
  Vec3d random_focus(Random&) const;
  double focus_size() const { return focus_size_; }

 private:
  std::size_t kind_;
  std::string name_;
  FieldTree tree_;
  std::vector<Vec3d> places_;
  double size_ = 1, focus_size_ = 1;
  Vec3d center_{};
  Box3 cells_;
  std::unique_ptr<EmbreeSurfaces> surfaces_;
};

}  // namespace marrow::test
