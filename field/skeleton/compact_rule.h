// Rules of nodes for the compact kernel along a line, over doubles or numbers with derivatives, whose nodes move with
// the support; internal to skeleton/.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <type_traits>

#include "field/kernel/inverse_family.h"
#include "field/kernel/panels.h"
#include "field/math/elementary.h"
#include "field/number/functions.h"
#include "field/skeleton/reach.h"

namespace marrow {
namespace compact_rule {

// Calls at(x, dx) with nodes x of [a, b], which move as a and b do: `nodes` calls its argument with those of values.
template <class X, class Nodes, class At>
void moving(const X& a, const X& b, const Nodes& nodes, const At& at) {
  if constexpr (std::is_same_v<X, double>) {
    nodes(at);
  } else {
    const double begin = value_of(a), width = value_of(b) - begin;
    if (!(width > 0)) return;
    const X across = b - a;
    nodes([&](double x, double weight) { at(a + across * ((x - begin) / width), across * (weight / width)); });
  }
}

// Over [0, length], the stretch from `begin` on, for integrands that are smooth but at these places.
template <class X, class Visit>
void along(const X& begin, const X& length, std::span<const Singularity> places, int degree, const Visit& visit) {
  const double width = value_of(length);
  const auto nodes = [&](const auto& at) {
    for_each_panel(0, width, places, width, [&](const Panel& panel) { for_each_node(panel, degree, at); });
  };
  moving(X(0.0), length, nodes, [&](const X& x, const X& dx) { visit(begin + x, dx); });
}

// Both ends are roots or near one: with t = middle + half sin(angle) half powers of E are powers of the cosine. Of a
// kernel of degree n the power is n + 1 at most, and derivatives and dt add four.
template <class X, class Visit>
void between_roots(const LineOf<X>& line, const X& from, const X& to, const X& begin, const X& end, int degree,
                   const Visit& visit) {
  const X middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const auto angle_of = [&](const X& t) {
    const X sine = (t - middle) / half;
    if (!(std::fabs(value_of(sine)) < 1)) return X(std::copysign(std::numbers::pi / 2, value_of(sine)));
    return asin(sine);
  };
  Singularity pole{0, std::numeric_limits<double>::infinity()};
  if (line.slope != 0) {
    const double at = (-value_of(line.at_foot) / line.slope - value_of(middle)) / value_of(half);
    pole = {std::copysign(std::numbers::pi / 2, at), acosh(std::max(1.0, std::fabs(at)))};
  }
  const X a = angle_of(begin), b = angle_of(end);
  const auto nodes = [&](const auto& at) { for_each_angle(value_of(a), value_of(b), pole, degree + 5, at); };
  moving(a, b, nodes, [&](const X& angle, const X& weight) {
    const auto [sine, cosine] = sincos(angle);
    visit(middle + half * sine, weight * half * cosine);
  });
}

// One end is a root or near one: with t = root + direction w^2 half powers of E are powers of w.
template <class X, class Visit>
void beyond_root(const LineOf<X>& line, const X& root, double direction, const std::optional<X>& other, const X& near,
                 const X& far, const Visit& visit) {
  const auto w_of = [&](const X& t) { return sqrt(max(direction * (t - root), X(0.0))); };
  const auto place = [&](double t) {
    const double w2 = direction * (t - value_of(root)), w = std::sqrt(std::fabs(w2));
    return w2 < 0 ? Singularity{0, w} : Singularity{w, 0};
  };
  constexpr Singularity nowhere{0, std::numeric_limits<double>::infinity()};
  const std::array<Singularity, 2> places{line.slope == 0 ? nowhere : place(-value_of(line.at_foot) / line.slope),
                                          other ? place(value_of(*other)) : nowhere};
  const X a = w_of(near), b = w_of(far);
  const auto nodes = [&](const auto& at) {
    for_each_panel(value_of(a), value_of(b), places, value_of(b),
                   [&](const Panel& panel) { for_each_node(panel, max_kernel_degree, at); });
  };
  moving(a, b, nodes, [&](const X& w, const X& weight) { visit(root + direction * square(w), 2.0 * weight * w); });
}

}  // namespace compact_rule

/// Calls visit(t, dt) such that sums of k(d/tau) times a polynomial of low degree are integrals along the line, to
/// 1e-13. `degree`: that of the kernel; m: its power is m/2 (Profile).
template <class X, class Visit>
void integrate_compact(const LineOf<X>& line, double R, int degree, int m, const Visit& visit) {
  using namespace compact_rule;
  const Reach<X> reach = reach_along(line, R);
  if (reach.is_empty) return;
  const X begin = reach.from && value_of(*reach.from) > value_of(line.t1) ? *reach.from : line.t1;
  const X end = reach.to && value_of(*reach.to) < value_of(line.t2) ? *reach.to : line.t2;
  const X stretch = end - begin;
  const double length = value_of(stretch), infinity = std::numeric_limits<double>::infinity();
  if (!(length > 0)) return;
  const auto place = [&](double t) { return Singularity{t - value_of(begin), 0}; };
  const Singularity tip =
      line.slope == 0 ? Singularity{0, infinity} : place(-value_of(line.at_foot) / line.slope);  // no radius there
  if (m % 2 == 0) {  // a polynomial over a power of the radius
    if (line.slope != 0) return along(begin, stretch, {&tip, 1}, m, visit);
    const auto nodes = [&](const auto& at) { for_each_polynomial_node(length, m + 1, at); };  // one for shares
    return moving(X(0.0), stretch, nodes, [&](const X& x, const X& dx) { visit(begin + x, dx); });
  }
  const bool is_near_from = reach.from && value_of(begin) - value_of(*reach.from) <= length;
  const bool is_near_to = reach.to && value_of(*reach.to) - value_of(end) <= length;
  if (is_near_from && is_near_to) return between_roots(line, *reach.from, *reach.to, begin, end, degree, visit);
  if (is_near_from) return beyond_root(line, *reach.from, 1, reach.to, begin, end, visit);
  if (is_near_to) return beyond_root(line, *reach.to, -1, reach.from, end, begin, visit);
  const Singularity nowhere{0, infinity};
  const std::array<Singularity, 3> places{tip, reach.from ? place(value_of(*reach.from)) : nowhere,
                                          reach.to ? place(value_of(*reach.to)) : nowhere};
  along(begin, stretch, places, max_kernel_degree, visit);
}

}  // namespace marrow
