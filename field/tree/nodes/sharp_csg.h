// Set operations with creases on the surface, and a smooth field around it.
#pragma once

#include <span>

#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/node_info.h"
#include "field/tree/nodes/crisp.h"
#include "field/tree/nodes/sharp_corner.h"

namespace marrow {

// The sharp operators of Barthe, Wyvill, de Groot 2004: the crisp surface in a field without other creases, so that the
// result can be blended further. As the soft ones (soft_csg.h), by formulas of our own (sharp_corner.h).

/// The union.
struct SharpUnion {
  static constexpr NodeInfo info{
      "sharp_union",
      "Union with a crease, in a field that is smooth but for it: unlike `union`, blends with "
      "it have no crease.",
      1, any_number_of_children};
  static constexpr bool ignores_zeros = true;
  double smooth = 1;

  static void keys(auto&& key) {
    key("smooth", &SharpUnion::smooth, form::fraction, "how far the field is rounded around the crease; 0: not at all");
  }
  /// Below the surface the field is at most the soft one's, sqrt(2) max(x, y), and at most 1; and the fold of values
  /// below 1 is below 1.
  double child_level(double level, std::size_t children) const {
    if (level >= 1) return 1;
    double most = 1;
    for (std::size_t i = 1; i < children && most < 1e6; ++i) most = std::sqrt(1 + most * most);
    return level / (most * (1 + 1e-12));
  }
  template <Number X>
  X value(std::span<const X> f) const {
    X whole = f[0];
    for (const X& x : f.subspan(1))
      whole = smooth > 0 ? SharpCorner{1 - smooth, 1 - smooth}.value(whole, x) : max(whole, x);
    return whole;
  }
  /// Whether a further child leaves what is before it as it is, or takes its place, all over these intervals.
  bool spares(const Interval& rest, const Interval& f) const {
    return smooth > 0 ? SharpCorner{1 - smooth, 1 - smooth}.is_first(rest, f) : f.hi <= rest.lo;
  }
  bool replaces(const Interval& rest, const Interval& f) const { return spares(f, rest); }
};

/// The intersection.
struct SharpIntersection {
  static constexpr NodeInfo info{"sharp_intersection",
                                 "Intersection with a crease, in a field that is smooth but for it: unlike "
                                 "`intersection`, blends with it have no crease.",
                                 1, any_number_of_children};
  double smooth = 1;

  static void keys(auto&& key) {
    key("smooth", &SharpIntersection::smooth, form::fraction,
        "how far the field is rounded around the crease; 0: not at all");
  }
  Box3 support(std::span<const Box3> children) const { return Intersection{}.support(children); }
  template <Number X>
  X value(std::span<const X> f) const {
    X common = f[0];
    for (const X& x : f.subspan(1)) common = both(common, x);
    return common;
  }
  /// Of two of them.
  template <Number X>
  X both(const X& x, const X& y) const {
    return smooth > 0 ? SharpCorner{1 + smooth, 1 + smooth}.value(x, y) : min(x, y);
  }
  /// As of a union.
  bool spares(const Interval& rest, const Interval& f) const {
    return smooth > 0 ? SharpCorner{1 + smooth, 1 + smooth}.is_first(rest, f) : f.lo >= rest.hi;
  }
  bool replaces(const Interval& rest, const Interval& f) const { return spares(f, rest); }
};

/// The first child without the others: the intersection with their complements 2 - f.
struct SharpDifference {
  static constexpr NodeInfo info{"sharp_difference",
                                 "Its first child without the others, with creases, in a field that is smooth but for "
                                 "them.",
                                 1, any_number_of_children};
  double smooth = 1;

  static void keys(auto&& key) {
    key("smooth", &SharpDifference::smooth, form::fraction,
        "how far the field is rounded around the creases; 0: not at all");
  }
  Box3 support(std::span<const Box3> children) const { return children[0]; }
  template <Number X>
  X value(std::span<const X> f) const {
    X rest = f[0];
    for (const X& x : f.subspan(1)) rest = SharpIntersection{smooth}.both(rest, max(complement(x), X(0.0)));
    return rest;
  }
  /// Whether a child with this field leaves all of the rest as it is.
  bool spares(const Interval& rest, const Interval& f) const {
    return SharpIntersection{smooth}.spares(rest, max(complement(f), Interval(0)));
  }
};

}  // namespace marrow
