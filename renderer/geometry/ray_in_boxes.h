// Where a ray is in boxes: in double, whatever floats the search of boxes goes by.
#pragma once

#include <cstddef>

#include "field/math/box3.h"
#include "field/math/ray.h"

namespace marrow {

/// Where a ray is in a box, before what is its end by now. A ray exactly in the plane of a padded face gives NaN and
/// may count either way; what the box is padded for is not there.
struct StretchInBox {
  double enter, exit;
  bool empty() const { return !(enter <= exit); }

  /// Between two planes across an axis.
  void clip(double lower, double upper, double origin, double inverse) {
    const double a = (lower - origin) * inverse, b = (upper - origin) * inverse;
    const double first = b < a ? b : a, last = a < b ? b : a;
    enter = enter < first ? first : enter;
    exit = last < exit ? last : exit;
  }
};

class RayInBoxes {
 public:
  RayInBoxes() = default;
  /// `last`: what lies behind it does not matter.
  RayInBoxes(const Ray& ray, double last) : origin_(ray.origin), t_min_(ray.t_min), last_(last) {
    for (std::size_t k = 0; k < 3; ++k) inverse_[k] = 1 / ray.direction.vec()[k];
  }
  void end_at(double last) { last_ = last; }

  StretchInBox in(const Box3& box) const {
    StretchInBox inside{t_min_, last_};
    for (std::size_t k = 0; k < 3; ++k) inside.clip(box.lower[k], box.upper[k], origin_[k], inverse_[k]);
    return inside;
  }

 private:
  Vec3d origin_, inverse_;  // the inverse of the direction
  double t_min_ = 0, last_ = 0;
};

}  // namespace marrow
