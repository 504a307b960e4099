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
    Box3 all = children[0];
    for (const Box3& b : children) all = common(all, b);
    return all;
  }
  template <Number X>
  X value(std::span<const X> f) const {
    X least = f[0];
    for (const X& x : f.subspan(1)) least = min(least, x);
    return least;
  }
};

/// 2 - f, the field of what a child leaves: 1 where f is. Enclosures keep 2 exact where f is 0, so that what is at most
/// 2 stays so: then cuts that are elsewhere can be dropped (Restriction), however many.
template <Number X>
X complement(const X& f) {
  return X(2.0) - f;
}
template <>
inline Interval complement(const Interval& f) {
  const Interval rest = Interval(2) - f;
  return {f.hi == 0 ? 2 : rest.lo, f.lo == 0 ? 2 : rest.hi};
}
template <std::size_t N>
Jet<Interval, N> complement(const Jet<Interval, N>& f) {
  Jet<Interval, N> rest = -f;
  rest.value = complement(f.value);
  return rest;
}

/// The first child without the others: min(f_1, 2 - f_i).
struct Difference {
  static constexpr NodeInfo info{"difference", "Its first child without the others, with creases.", 1,
                                 any_number_of_children};
  static void keys(auto&&) {}

  Box3 support(std::span<const Box3> children) const { return children[0]; }
  template <Number X>
  X value(std::span<const X> f) const {
    X rest = f[0];
    for (const X& x : f.subspan(1)) rest = min(rest, complement(x));
    return max(rest, X(0.0));
  }
};

}  // namespace marrow
