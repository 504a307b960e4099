// A projection angle that varies in space.
#pragma once

#include "field/math/box3.h"
#include "field/number/interval.h"
#include "field/number/jet.h"

namespace marrow {

/// Radians, and their gradient.
struct AlphaSample {
  double value = 0;
  Vec3d gradient{};
};

/// An angle given at every point, in the coordinates of the blend; immutable.
class AlphaSource {
 public:
  AlphaSource() = default;
  AlphaSource(const AlphaSource&) = delete;
  AlphaSource& operator=(const AlphaSource&) = delete;
  virtual ~AlphaSource() = default;
  virtual AlphaSample at(const Vec3d& p) const = 0;
  /// With its second derivatives by p.
  virtual HessianJet second_order_at(const Vec3d& p) const = 0;
  /// All angles in a box.
  virtual Interval bounds(const Box3&) const = 0;
  /// All their gradients.
  virtual Vec3<Interval> slopes(const Box3&) const {
    return {Interval::everything(), Interval::everything(), Interval::everything()};
  }
};

}  // namespace marrow
