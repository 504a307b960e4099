// Whether a place is outside a blend, by groups of its sources: for whoever need not know the field itself.
#pragma once

#include "field/math/vec3.h"
#include "field/trace/curve/iso_curve.h"
#include "field/trace/sources/near_far.h"
#include "field/trace/sources/source_tree.h"

namespace marrow {

/// Refers to what it is made of.
class OutsideBound {
 public:
  /// Of `rules` it takes those for near pieces, and by how much a group may be off.
  OutsideBound(const SourceTree& tree, const NearFar& rules, const IsoCurve& iso)
      : tree_(tree), rules_(rules), iso_(iso) {}

  /// Whether the corrected field is below 1 - clearly_below at p, for any angle of the curve. Never wrongly true; it is
  /// true at nearly all places with a field below 0.95.
  bool holds(const Vec3d& p) const;

  static constexpr double clearly_below = 1e-3;

 private:
  struct Sums;
  bool add_group(const SourceNode&, const Vec3d& from_group, Sums&) const;
  bool add_piece(const Piece&, const Vec3d& p, Sums&) const;

  const SourceTree& tree_;
  const NearFar& rules_;
  const IsoCurve& iso_;
};

}  // namespace marrow
