// The skeletons whose near field counts in a part of space (angle/local_contact.h); internal to blend/.
#pragma once

#include "field/blend/blend_field.h"
#include "field/math/box3.h"

namespace marrow {

/// The near field falls with so high a power of distances that few skeletons tell it. Immutable.
class NearSkeletons {
 public:
  /// What those left out add to the near field at most, over that field.
  static constexpr double most_left_out = 1e-9;

  /// None.
  NearSkeletons() = default;
  /// All of a blend: each as an integral, whatever its model.
  explicit NearSkeletons(const BlendField&);
  /// Those that count in a box.
  NearSkeletons within(const Box3&) const;

  /// Value and gradient of the near field, in this part of space.
  SkeletonSample at(const Vec3d& p) const;
  /// |grad ln| of the near field of any of them at most, within rho of a place. Infinite where one is that near.
  double log_slope(const Vec3d& center, double rho) const;
  std::size_t size() const { return skeletons_.size(); }

 private:
  BlendField skeletons_;  // under the kernel of the near field
};

}  // namespace marrow
