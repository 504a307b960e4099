// A blend below operators, and where its surface is that of the whole.
//
// Many operators reach only so far: soft set operations round a crease and leave fields elsewhere as they are, contact
// begins where another field is near, and what has a bounded support is 0 beyond it. Everywhere else the blend alone
// has the surface, and its own tracer finds it far sooner than that of general trees. What the operators make of the
// fields tells where that is: not where the whole equals the blend, but where it is below 1 if the blend is, and above
// 1 if the blend is.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "field/math/affine.h"
#include "field/math/box3.h"
#include "field/math/side.h"
#include "field/tree/field_tree.h"

namespace marrow {

struct BlendField;

/// Immutable; safe to use from many threads.
class BlendInTree {
 public:
  /// Of the largest blend in a tree that is wanted; null where there is none, where it occurs twice, or stands below
  /// anything but operators and placements, or where it decides about less than half of the space around it.
  static std::shared_ptr<const BlendInTree> of(const FieldTree&, const std::function<bool(const BlendField&)>& wanted);

  const FieldTree& tree() const { return tree_; }
  const std::shared_ptr<const BlendField>& blend() const { return blend_; }
  const Affine& tree_from_blend() const { return tree_from_blend_; }

  /// By how much the blend's field may differ from 1 where that of the whole is 1 and the blend decides: a tenth of
  /// what traced fields are off.
  static constexpr double tolerance = 1e-6;

  /// Whether all surface of the whole in a box is the blend's, and all of the blend's that of the whole; false: none of
  /// the blend's is. Nothing where it is so in places, or not known.
  std::optional<bool> decides(const Box3&) const;
  /// decides() for the box and as much around it as a traced surface may lie beside the exact one.
  bool decides_around(const Box3&) const;
  /// Of the whole, all over the box, if that of the blend is so.
  Side side(const Box3&, Side of_blend) const;

 private:
  BlendInTree(FieldTree, std::uint32_t leaf, std::shared_ptr<const BlendField>, const Affine& tree_from_blend);
  class Asked;
  std::optional<bool> asked(const Box3&) const;
  void find_undecided();

  FieldTree tree_;
  std::uint32_t leaf_;  ///< record of the blend
  std::shared_ptr<const BlendField> blend_;
  Affine tree_from_blend_;
  Box3 bounds_;     ///< of surface, of the whole and of the blend
  Box3 undecided_;  ///< all else in the bounds is decided
  double decided_;  ///< share of the bounds of the blend
  double beside_;   ///< how far traced surface may lie beside the exact one, and much more
};

}  // namespace marrow
