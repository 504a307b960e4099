// On which side of a blend's surface a place is, by groups of its sources: for whoever need not know the field itself.
#pragma once

#include "field/math/box3.h"
#include "field/math/side.h"
#include "field/math/vec3.h"
#include "field/trace/curve/iso_curve.h"
#include "field/trace/sources/near_far.h"
#include "field/trace/sources/source_tree.h"

namespace marrow {

/// Refers to what it is made of.
class SideBound {
 public:
  /// Of `rules` it takes those for near pieces, and by how much a group may be off.
  SideBound(const SourceTree& tree, const NearFar& rules, const IsoCurve& iso)
      : tree_(tree), rules_(rules), iso_(iso) {}

  /// Outside: the corrected field is below 1 - clearly at p, for any angle of the curve; inside: it is above
  /// 1 + clearly. Never wrong; known at nearly all places with a field below 0.95 or above 1.05.
  Side side(const Vec3d& p) const;
  /// Of all places in a box: known where it is away from the skeletons by more than about its own size, or close to
  /// one.
  Side side(const Box3&) const;

  static constexpr double clearly = 1e-3;

 private:
  struct Sums;
  bool add_group(const SourceNode&, const Vec3d& from_group, Sums&) const;
  bool add_piece(const Piece&, const Vec3d& p, int halvings, Sums&) const;
  bool add_leaf(const SourceNode&, const Vec3d& p, Sums&) const;
  bool is_inside_alone(const SourceNode& leaf, const Vec3d& p) const;
  Side side_by(const Sums&) const;
  Side side_by_sums(const Vec3d& p, double may_be_off) const;
  struct Ball;
  bool add_leaf(const SourceNode&, Ball&) const;

  const SourceTree& tree_;
  const NearFar& rules_;
  const IsoCurve& iso_;
};

}  // namespace marrow
