// Set operations whose creases are rounded, by an amount that each side controls for itself.
#pragma once

#include <span>

#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/node_info.h"
#include "field/tree/nodes/crisp.h"
#include "field/tree/nodes/ellipse_corner.h"

namespace marrow {

// The properties are those of Barthe, Wyvill, de Groot 2004 (Controllable binary CSG operators for soft objects): a
// field that is 0 where the result has no influence, the crisp operation outside an angle of the plane of the two
// fields that two control points span, arcs of ellipses within, tangent to what they join, so C1 but for the origin.
// Their text was not at hand; the formulas are our own (ellipse_corner.h), for a surface at 1, a fixed angle at every
// level, and folding from the left for more than two children, of which "the first" then are all before. Sharp ones,
// whose surface has the crease and whose field has none else, are in sharp_csg.h.

/// The union. A control value of 0 begins where the other field begins; with 1 there is a crease.
struct SoftUnion {
  static constexpr NodeInfo info{"soft_union",
                                 "Union with a rounded crease; each side controls where the rounding begins. Of more "
                                 "than two children each joins the union of all before it, which is the first then.",
                                 1, any_number_of_children};
  static constexpr bool ignores_zeros = true;
  double on_first = 0.5, on_second = 0.5;

  static void keys(auto&& key) {
    key("on_first", &SoftUnion::on_first, form::fraction,
        "field of the second child at which the surface of the first begins to change; 1 makes a crease");
    key("on_second", &SoftUnion::on_second, form::fraction,
        "field of the first child at which the surface of the second begins to change; 1 makes a crease");
  }
  /// Folds that no longer gain stay as they are.
  double child_level(double level, std::size_t children) const {
    double most = 1;
    for (std::size_t i = 1; i < children; ++i) {
      const double next = both(most, 1.0);
      if (next == most) break;
      most = next;
    }
    return level / (most * (1 + 1e-12));
  }
  template <Number X>
  X value(std::span<const X> f) const {
    X whole = f[0];
    for (const X& x : f.subspan(1)) whole = both(whole, x);
    return whole;
  }
  /// Whether a further child leaves what is before it as it is, or takes its place, all over these intervals.
  bool spares(const Interval& rest, const Interval& f) const {
    return f.hi <= (Interval(is_round() ? on_first : 1) * rest).lo;
  }
  bool replaces(const Interval& rest, const Interval& f) const {
    return rest.hi <= (Interval(is_round() ? on_second : 1) * f).lo;
  }

 private:
  bool is_round() const { return on_first < 1 && on_second < 1; }
  template <Number X>
  X both(const X& x, const X& y) const {
    return is_round() ? EllipseCorner{on_second, on_first}.value(x, y) : max(x, y);
  }
};

/// The intersection.
struct SoftIntersection {
  static constexpr NodeInfo info{"soft_intersection",
                                 "Intersection with a rounded crease; each side controls where the rounding begins. Of "
                                 "more than two children each meets the intersection of all before it, which is the "
                                 "first then.",
                                 1, any_number_of_children};
  double on_first = 1.5, on_second = 1.5;

  static void keys(auto&& key) {
    key("on_first", &SoftIntersection::on_first, form::Real{.min = 1, .max = 1e3},
        "field of the second child above which the surface of the first stays; 1 makes a crease");
    key("on_second", &SoftIntersection::on_second, form::Real{.min = 1, .max = 1e3},
        "field of the first child above which the surface of the second stays; 1 makes a crease");
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
    return is_round() ? EllipseCorner{on_second, on_first}.value(x, y) : min(x, y);
  }
  /// As of a union.
  bool spares(const Interval& rest, const Interval& f) const {
    return f.lo >= (Interval(is_round() ? on_first : 1) * rest).hi;
  }
  bool replaces(const Interval& rest, const Interval& f) const {
    return rest.lo >= (Interval(is_round() ? on_second : 1) * f).hi;
  }

 private:
  bool is_round() const { return on_first > 1 && on_second > 1; }
};

/// The first child without the others: the intersection with their complements 2 - f.
struct SoftDifference {
  static constexpr NodeInfo info{
      "soft_difference",
      "Its first child without the others, one after another, with rounded creases; each side "
      "controls where the rounding begins.",
      1, any_number_of_children};
  double on_first = 0.5, on_second = 1.5;

  static void keys(auto&& key) {
    key("on_first", &SoftDifference::on_first, form::fraction,
        "field of the others below which the surface of the first child stays; 1 makes a crease");
    key("on_second", &SoftDifference::on_second, form::Real{.min = 1, .max = 1e3},
        "field of the first child above which the walls of the cut stay; 1 makes a crease");
  }
  Box3 support(std::span<const Box3> children) const { return children[0]; }
  template <Number X>
  X value(std::span<const X> f) const {
    const SoftIntersection common{2 - on_first, on_second};
    X rest = f[0];
    for (const X& x : f.subspan(1)) rest = common.both(rest, max(complement(x), X(0.0)));
    return rest;
  }
  /// As of a union: 2 - f is above (2 - on_first) times the rest.
  bool spares(const Interval& rest, const Interval& f) const {
    return complement(f).lo >= std::max(0.0, (Interval(2 - on_first) * rest).hi);
  }
};

}  // namespace marrow
