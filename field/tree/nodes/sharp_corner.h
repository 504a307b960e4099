// Two fields joined by a corner that is sharp on the surface and rounded everywhere else.
#pragma once

#include "field/number/functions.h"
#include "field/tree/nodes/ellipse_corner.h"

namespace marrow {

/// As EllipseCorner, but that the rounding of the iso-curve at C is (1 - a) w and (1 - b) w wide with w = C (1 - C)
/// below the surface and C - 1 above it, instead of C. So the surface is that of the crisp operation, with its crease,
/// and the field is C1 but for the crease and the origin: what is blended with it later has no other crease. Iso-curves
/// do not cross, and partial derivatives are in [0, 1], because |w'| <= 1 and |1 - a|, |1 - b| <= 1.
struct SharpCorner {
  double a = 0.5, b = 0.5;  ///< both in [0, 1), a union, or both in (1, 2], an intersection

  /// Of x, y >= 0.
  template <Number X>
  X value(const X& x, const X& y) const;
  /// Whether the value is x all over a box.
  bool is_first(const Interval& x, const Interval& y) const { return is_line(x, y, b); }

 private:
  bool is_union() const { return a < 1; }
  /// Where the arc of the iso-curve at c begins on its straight line, as the other field; rises with c.
  static double border(double c, double control) {
    return c <= 1 ? c - (1 - control) * (c * (1 - c)) : 1 + control * (c - 1);
  }
  /// Whether the value is f all over a box.
  bool is_line(const Interval& f, const Interval& other, double control) const {
    return is_union() ? other.hi <= border(f.lo, control) : other.lo >= border(f.hi, control);
  }
  bool inside(double x, double y) const { return is_union() ? !(x > 1 || y > 1) : !(x > 1 && y > 1); }
  EllipseCorner above() const { return {a, b}; }

  /// On the iso-curve at c, U^2 + V^2 = 1 for U = 1 - (c - x) / ((1 - a) w) and V alike; cut at 0, where only one of
  /// the lines counts.
  template <Number X>
  struct OnArc {
    X U, V, slope;  ///< slope: w'
  };
  template <Number X>
  OnArc<X> on_arc(const X& x, const X& y, const X& c) const {
    const X w = c * (X(1.0) - c);
    const auto part = [&](const X& f, double control) { return max(X(1.0) - (c - f) / (X(1 - control) * w), X(0.0)); };
    return {part(x, a), part(y, b), X(1.0) - X(2.0) * c};
  }
  /// Of U^2 + V^2 - 1 by c, times w/2, with the opposite sign.
  template <Number X>
  X fall(const OnArc<X>& p) const {
    return p.U * X(1 / (1 - a)) + p.V * X(1 / (1 - b)) - p.slope * (p.U * (X(1.0) - p.U) + p.V * (X(1.0) - p.V));
  }
  /// Below the surface, for numbers.
  double solve(double x, double y) const;
  Interval enclosed_at(double x, double y) const;
  EllipseCorner::Partials partials(const Interval& x, const Interval& y, const Interval& c) const;

  template <Number X>
  X below(const X& x, const X& y) const;
};

/// Steps of Newton's method from the solution add its first and second derivatives, and digits to longer numbers.
template <Number X>
X SharpCorner::below(const X& x, const X& y) const {
  const double u = lower(x), v = lower(y);
  if (is_line(u, v, b)) return x;
  if (is_line(v, u, a)) return y;
  X r(solve(u, v));
  if constexpr (!std::same_as<X, double>) {
    for (int step = 0; step < 3; ++step) {
      const OnArc<X> p = on_arc(x, y, r);
      r += (square(p.U) + square(p.V) - X(1.0)) * X(0.5) * r * (X(1.0) - r) / fall(p);
    }
  }
  return r;
}

template <Number X>
X SharpCorner::value(const X& x, const X& y) const {
  if constexpr (!is_enclosure<X>) {
    if (inside(lower(x), lower(y))) return below(x, y);
    return X(1.0) + above().value(x - X(1.0), y - X(1.0));
  } else if constexpr (!JetNumber<X>) {
    return {enclosed_at(std::max(0.0, x.lo), std::max(0.0, y.lo)).lo,
            enclosed_at(std::max(0.0, x.hi), std::max(0.0, y.hi)).hi};
  } else {
    X r(value(x.value, y.value));
    const EllipseCorner::Partials d = partials(x.value, y.value, r.value);
    for (std::size_t i = 0; i < r.slope.size(); ++i) r.slope[i] = d.x * x.slope[i] + d.y * y.slope[i];
    return r;
  }
}

}  // namespace marrow
