// Two fields joined by an arc of an ellipse: the rounded corner behind the soft set operations.
#pragma once

#include <algorithm>
#include <cmath>

#include "field/number/functions.h"

namespace marrow {

/// The field C(x, y) whose iso-curves are, in the plane of two fields x, y: a vertical line x = C, a horizontal one
/// y = C, and between (C, b C) and (a C, C) a quarter of an ellipse that touches both there. With a, b < 1 the lines
/// come from below and the left, so that C is max(x, y) beyond the rays y = b x and x = a y and more between: a union.
/// With a, b > 1 they come from above and the right, and C is min(x, y) beyond the rays and less between: an
/// intersection. Only directions matter, so C(s x, s y) = s C(x, y). C is C1 but for the origin. Its iso-curves bound
/// convex sets, so that its partial derivatives rise or fall all the way from ray to ray, within [0, 1].
struct EllipseCorner {
  double a = 0.5, b = 0.5;  ///< both in [0, 1), or both above 1

  /// Of x, y >= 0; one of them may be below 0 in a union.
  template <Number X>
  X value(const X& x, const X& y) const;
  /// Partial derivatives over a box, [0, 1] where it is only the origin.
  struct Partials {
    Interval x, y;
  };
  Partials partials(const Interval& x, const Interval& y) const;

 private:
  enum class Part { Vertical, Horizontal, Arc };

  // A union is infinite where one of both is.
  Part part(double x, double y) const {
    if (a < 1 && std::isinf(std::max(x, y))) return x >= y ? Part::Vertical : Part::Horizontal;
    if (a < 1 ? y <= b * x : y >= b * x) return Part::Vertical;
    if (a < 1 ? x <= a * y : x >= a * y) return Part::Horizontal;
    return Part::Arc;
  }
  /// C solves ((x - a C) / (1 - a))^2 + ((y - b C) / (1 - b))^2 = C^2. With t = (x, y) and s = (a, b), each divided by
  /// (1 - a, 1 - b), that is (s.s - 1) C^2 - 2 (s.t) C + t.t = 0, whose discriminant is t.t - (s x t)^2 by Lagrange's
  /// identity. A union has the smaller root or the only positive one, an intersection, where s.s > 1, the larger one.
  template <Number X>
  X arc(const X& x, const X& y) const {
    using T = ScalarOf<X>;
    const T width_a = T(1) - T(a), width_b = T(1) - T(b);
    const T sx = T(a) / width_a, sy = T(b) / width_b;
    const X tx = x / X(width_a), ty = y / X(width_b);
    const X tt = square(tx) + square(ty), st = X(sx) * tx + X(sy) * ty;
    const X root = sqrt(max(tt - square(X(sx) * ty - X(sy) * tx), X(0.0)));
    return a < 1 ? tt / (st + root) : (st + root) / X(square(sx) + square(sy) - T(1));
  }
  template <Number X>
  X at_point(const X& x, const X& y) const {
    const Part p = part(lower(x), lower(y));
    if (p != Part::Arc) return p == Part::Vertical ? x : y;
    const double s = scale(lower(x), lower(y));
    return s == 1 ? arc(x, y) : arc(x * X(s), y * X(s)) * X(1 / s);
  }
  // By which both are multiplied so that their squares are finite.
  static double scale(double x, double y) { return std::max(x, y) > 1e100 ? 0x1p-700 : 1; }
  Partials partials_at(double x, double y) const;
};

/// Over a box, the value rises with both fields, and each partial derivative is extreme at the corners where y/x is.
template <Number X>
X EllipseCorner::value(const X& x, const X& y) const {
  if constexpr (!is_enclosure<X>) {
    return at_point(x, y);
  } else if constexpr (!JetNumber<X>) {
    const Interval u = max(x, Interval(0)), v = max(y, Interval(0));
    const Interval least = at_point(Interval(u.lo), Interval(v.lo)), most = at_point(Interval(u.hi), Interval(v.hi));
    return {std::max(0.0, least.lo), most.hi};
  } else {
    const Partials d = partials(x.value, y.value);
    X r(value(x.value, y.value));
    for (std::size_t i = 0; i < r.slope.size(); ++i) r.slope[i] = d.x * x.slope[i] + d.y * y.slope[i];
    return r;
  }
}

}  // namespace marrow
