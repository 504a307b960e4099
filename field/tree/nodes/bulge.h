// The bulges that make room for what a body in contact has lost.
#pragma once

#include <numbers>
#include <string>
#include <variant>

#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// A bulge is a function b of another body's field t, from b(c) = b'(c) = 0 to b(1) = 0, b'(1) = -1, where the contact
/// goes on with 1 - t: so the surface stays smooth around the contact. Below c it is 0.
/// [Angelidis, Jepp, Cani 2002, sec. 5; with other coefficients, since the printed ones miss b'(1) = -1]
namespace bulge {

/// From b(m) = h, b'(m) = 0 to b(1) = 0, b'(1) = -1: the cubic of Hermite's conditions. h is its largest value while
/// h >= (1 - m) / 3.
template <Number X>
X outer_flank(const X& t, double m, double h) {
  const double width = 1 - m;
  const X x = (t - X(m)) * X(1 / width);
  return X(h) + (X(width - 3 * h) + X(2 * h - width) * x) * square(x);
}
/// h from t = m on downwards to 0 at c, with no slope at both ends: (3 - 2 x) x^2 h, x from c to m.
template <Number X>
X inner_flank(const X& t, double c, double m, double h) {
  const X x = clamp((t - X(c)) * X(1 / (m - c)), 0, 1);
  return X(h) * square(x) * (X(3.0) - X(2.0) * x);
}

inline constexpr form::Real between_0_and_1{.min = 0, .max = 0.999, .min_open = true};

}  // namespace bulge

/// (1 - c) x^2 (1 - x), x from c to 1.
struct PlainBulge {
  static constexpr NodeInfo info{"plain", "A bulge as wide as its range allows; its height follows."};
  double from = 0.4;
  static void keys(auto&& key) {
    key("from", &PlainBulge::from, bulge::between_0_and_1, "field of the other body at which the bulge ends");
  }
  std::string problem() const { return {}; }
  template <Number X>
  X value(const X& t) const {
    const X x = (t - X(from)) * X(1 / (1 - from));
    return X(1 - from) * square(x) * (X(1.0) - x);
  }
};

/// Two cubics that meet at its largest value.
struct HeightBulge {
  static constexpr NodeInfo info{"height", "A bulge with a height of its own, and a place for it."};
  double from = 0.2, at = 0.65, height = 0.25;  // those of the paper's Fig. 12 (b), for a surface at 1
  static void keys(auto&& key) {
    key("from", &HeightBulge::from, bulge::between_0_and_1, "field of the other body at which the bulge ends");
    key("at", &HeightBulge::at, bulge::between_0_and_1, "field of the other body where it is highest");
    key("height", &HeightBulge::height, bulge::between_0_and_1, "what it adds to the field there");
  }
  std::string problem() const {
    if (!(from < at)) return "at must be above from";
    return height * 3 >= 1 - at ? "" : "height must be at least (1 - at) / 3, to be the largest value";
  }
  template <Number X>
  X value(const X& t) const {
    return piecewise(
        t, at, [&](const X& x) { return bulge::inner_flank(x, from, at, height); },
        [&](const X& x) { return bulge::outer_flank(x, at, height); });
  }
};

/// As HeightBulge, its inner flank in waves: (3 - 2 x) x^2 h (1 + cos(((2 n + 1) x + 1) pi)) / 2. The highest one is so
/// placed that all have the same length.
struct RippleBulge {
  static constexpr NodeInfo info{"ripples", "A bulge with ripples around it."};
  double from = 0.2, height = 0.25;
  int ripples = 2;
  static void keys(auto&& key) {
    key("from", &RippleBulge::from, bulge::between_0_and_1, "field of the other body at which the ripples end");
    key("height", &RippleBulge::height, bulge::between_0_and_1, "what the highest ripple adds to the field");
    key("ripples", &RippleBulge::ripples, form::Whole{.min = 1, .max = 100}, "their number, without the highest");
  }
  double at() const { return from + (1 - from) * (1 - 1.0 / (4 * ripples + 3)); }
  std::string problem() const {
    return height * 3 >= 1 - at() ? ""
                                  : "height must be at least (1 - from) / (3 (4 ripples + 3)), to be the largest value";
  }
  template <Number X>
  X value(const X& t) const {
    return piecewise(
        t, at(), [&](const X& x) { return bulge::inner_flank(x, from, at(), height) * wave(x); },
        [&](const X& x) { return bulge::outer_flank(x, at(), height); });
  }

 private:
  /// cos^2 of half the angle, which is an odd multiple of pi/2 at x = 0.
  template <Number X>
  X wave(const X& t) const {
    const X x = (t - X(from)) * X(1 / (at() - from));
    return square(sin((X(2.0 * ripples + 1) * x) * X(0.5 * std::numbers::pi)));
  }
};

using Bulge = std::variant<PlainBulge, HeightBulge, RippleBulge>;

/// The bulge, at a field t below 1 of another body.
template <Number X>
X bulge_term(const Bulge& bulge, const X& t) {
  return std::visit(
      [&](const auto& b) {
        return piecewise(
            t, b.from, [](const X&) { return X(0.0); }, [&](const X& x) { return b.value(x); });
      },
      bulge);
}

/// What a body's field gains at the field t of another body: the bulge around it, and 1 - t inside.
template <Number X>
X contact_term(const Bulge& bulge, const X& t) {
  return piecewise(
      t, 1, [&](const X& x) { return bulge_term(bulge, x); }, [](const X& x) { return X(1.0) - x; });
}

/// A body's own field with what it gains at another's. The difference comes first, as fields of 1e30 near skeletons
/// would lose the 1. Where both are infinite, at a node of both, this is too: another's counts up to 1e300.
template <Number X>
X deformed(const Bulge& bulge, const X& own, const X& other) {
  return piecewise(
      other, 1, [&](const X& x) { return own + bulge_term(bulge, x); },
      [&](const X& x) { return (own - min(x, X(1e300))) + X(1.0); });
}

}  // namespace marrow
