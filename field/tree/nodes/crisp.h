// Crisp set operations: creases where surfaces meet.
#pragma once

#include <span>

#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// What is in any child: the largest value.
struct CrispUnion {
  static constexpr bool ignores_zeros = true;
  template <Number X>
  X value(std::span<const X> f) const {
    X most = f[0];
    for (const X& x : f.subspan(1)) most = max(most, x);
    return most;
  }
};

/// What is in all children: the smallest value.
struct Intersection {
  static constexpr NodeInfo info{"intersection", "What is inside all of its children, with creases.", 1,
                                 any_number_of_children};
  static void keys(auto&&) {}

  Box3 support(std::span<const Box3> children) const {
    Box3 common = children[0];
    for (const Box3& b : children) {
      for (std::size_t i = 0; i < 3; ++i) {
        common.lower[i] = std::max(common.lower[i], b.lower[i]);
        common.upper[i] = std::min(common.upper[i], b.upper[i]);
      }
    }
    return common;
  }
  template <Number X>
  X value(std::span<const X> f) const {
    X least = f[0];
    for (const X& x : f.subspan(1)) least = min(least, x);
    return least;
  }
};

/// The first child without the others: min(f_1, 2 - f_i), since 2 - f is 1 where f is.
struct Difference {
  static constexpr NodeInfo info{"difference", "Its first child without the others, with creases.", 1,
                                 any_number_of_children};
  static void keys(auto&&) {}

  Box3 support(std::span<const Box3> children) const { return children[0]; }
  template <Number X>
  X value(std::span<const X> f) const {
    X rest = f[0];
    for (const X& x : f.subspan(1)) rest = min(rest, X(2.0) - x);
    return max(rest, X(0.0));
  }
};

}  // namespace marrow
