// Where rays are in boxes: in double, whatever floats the search of boxes goes by.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "field/math/box3.h"
#include "field/math/ray.h"

namespace marrow {

/// Where a ray is in a box, before what is its end by now. A ray exactly in the plane of a padded face gives NaN and
/// may count either way; what the box is padded for is not there.
struct StretchInBox {
  double enter, exit;
  bool empty() const { return !(enter <= exit); }
};

/// Some rays side by side, of which in() answers for all at once: all lanes must hold rays.
template <std::size_t Count>
class RaysInBoxes {
 public:
  /// `last`: what lies behind it does not matter.
  void set(std::size_t lane, const Ray& ray, double last) {
    for (std::size_t k = 0; k < 3; ++k) {
      origin_[k][lane] = ray.origin[k];
      inverse_[k][lane] = 1 / ray.direction.vec()[k];
    }
    t_min_[lane] = ray.t_min;
    last_[lane] = last;
  }
  void end_at(std::size_t lane, double last) { last_[lane] = last; }

  StretchInBox in(const Box3& box, std::size_t lane) const {
    double enter = t_min_[lane], exit = last_[lane];
    for (std::size_t k = 0; k < 3; ++k)
      clip(box.lower[k], box.upper[k], origin_[k][lane], inverse_[k][lane], enter, exit);
    return {enter, exit};
  }

  /// The same of all of them: where they come in, and a bit for each that does.
  struct Entries {
    double enter[Count];
    std::uint32_t in_box = 0;
  };
  Entries in(const Box3& box) const {
    static_assert(Count <= 32);
    Entries entries;
    double enter[Count], exit[Count];
    std::copy_n(t_min_, Count, enter);
    std::copy_n(last_, Count, exit);
    for (std::size_t k = 0; k < 3; ++k) {
      const double lower = box.lower[k], upper = box.upper[k];
      for (std::size_t lane = 0; lane < Count; ++lane)
        clip(lower, upper, origin_[k][lane], inverse_[k][lane], enter[lane], exit[lane]);
    }
    for (std::size_t lane = 0; lane < Count; ++lane)
      entries.in_box |= static_cast<std::uint32_t>(enter[lane] <= exit[lane]) << lane;
    std::copy_n(enter, Count, entries.enter);
    return entries;
  }

 private:
  // By values, so that lanes go side by side into registers.
  static void clip(double lower, double upper, double origin, double inverse, double& enter, double& exit) {
    const double a = (lower - origin) * inverse, b = (upper - origin) * inverse;
    const double first = b < a ? b : a, last = a < b ? b : a;
    enter = enter < first ? first : enter;
    exit = last < exit ? last : exit;
  }

  double origin_[3][Count], inverse_[3][Count];  // the inverse of the direction
  double t_min_[Count], last_[Count];
};

}  // namespace marrow
