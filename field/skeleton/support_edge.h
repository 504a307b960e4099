// Where the edge of a compact kernel's support cuts an arc or the lines of a triangle; internal to skeleton/.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "field/kernel/adaptive.h"
#include "field/math/elementary.h"
#include "field/math/gauss_rule.h"
#include "field/skeleton/arc_view.h"
#include "field/skeleton/triangle_view.h"

namespace marrow {

/// An interval, cut at a few places within it.
class Cuts {
 public:
  static constexpr std::size_t most_pieces = 11;

  Cuts(double begin, double end) : places_{begin, end} {}
  /// Not where it would leave a piece that is short beyond sense: there rounding decides how far the edge is.
  void add(double x) {
    const double least = 1e-12 * (places_[last_] - places_[0]);
    const auto is_near = [&](double place) { return !(std::fabs(x - place) > least); };
    if (!(x > places_[0] && x < places_[last_]) || last_ + 1 == places_.size()) return;
    if (std::any_of(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(last_) + 1, is_near)) return;
    std::size_t at = ++last_;
    for (; places_[at - 1] > x || at == last_; --at) places_[at] = places_[at - 1];
    places_[at] = x;
  }
  /// Calls visit(begin, end) for each piece, in order.
  template <class Visit>
  void for_each_piece(const Visit& visit) const {
    for (std::size_t i = 0; i < last_; ++i) visit(places_[i], places_[i + 1]);
  }

 private:
  std::array<double, most_pieces + 1> places_{};  // begin, cuts and end, ascending
  std::size_t last_ = 1;
};

/// Adds the roots of a x^2 + 2 b x + c, without cancellation.
inline void add_roots(double a, double b, double c, Cuts& cuts) {
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0)) return;
  const double q = -b - std::copysign(std::sqrt(discriminant), b);
  for (const double root : {c / q, q / a})
    if (std::isfinite(root)) cuts.add(root);
}
/// Adds where a function that rises or falls all over [a, b] changes its sign.
template <class Function>
void add_sign_change(const Function& f, double a, double b, Cuts& cuts) {
  const bool below = f(a) < 0;
  if (!(a < b) || (f(b) < 0) == below) return;
  for (double middle = (a + b) / 2; a < middle && middle < b; middle = (a + b) / 2)
    ((f(middle) < 0) == below ? a : b) = middle;
  cuts.add(b);
}

/// Of an arc from `near` to `far`, angles x in [0, pi] to one side of the place nearest to the point, of radius
/// tau + slope x: the zeros of E(x) = d^2 - R^2 tau(x)^2, of which there are at most three, as E'' vanishes once. Where
/// the radius stays as it is E rises, and `far` is no farther than its zero.
inline Cuts edges_on_arc(const ArcView& v, double tau, double slope, double R, double near, double far) {
  if (slope == 0) return {near, far};
  const double chord = 2 * v.r * v.major, R2 = R * R, steady = R2 * slope * slope;
  const auto excess = [&](double x) {
    const double half = sin(x / 2), radius = tau + slope * x;
    return v.gap() + 2 * chord * half * half - R2 * radius * radius;
  };
  const auto rise = [&](double x) { return chord * sin(x) - 2 * R2 * slope * (tau + slope * x); };
  const auto each_piece = [](const Cuts& cuts, const auto& f, Cuts& found) {
    cuts.for_each_piece([&](double a, double b) { add_sign_change(f, a, b, found); });
  };
  Cuts bends(near, far), turns(near, far), edges(near, far);
  if (2 * steady < chord) bends.add(acos(2 * steady / chord));
  each_piece(bends, rise, turns);
  each_piece(turns, excess, edges);
  return edges;
}

/// Over the heights x of a triangle's lines, in [begin, end]: where an end of the line crosses the edge, and where the
/// edge leaves the line.
inline Cuts edges_on_lines(const TriangleView& v, double R, double begin, double end) {
  Cuts cuts(begin, end);
  const double R2 = R * R, slope = (v.radius_end - v.radius_begin) / v.base, n2 = v.p_normal * v.p_normal;
  struct Side {
    double u0, u1, tau0, tau1;  // place along the line and radius, linear in x
  };
  const auto side = [&](double from_u, double radius) {
    const double u1 = (v.apex_u - from_u) / v.apex_w, tau1 = (v.radius_apex - radius) / v.apex_w;
    return Side{from_u + u1 * v.p_w - v.p_u, u1, radius + tau1 * v.p_w, tau1};
  };
  const Side first = side(0, v.radius_begin), second = side(v.base, v.radius_end);
  for (const Side& s : {first, second})
    add_roots(s.u1 * s.u1 + 1 - R2 * s.tau1 * s.tau1, s.u0 * s.u1 - R2 * s.tau0 * s.tau1,
              s.u0 * s.u0 + n2 - R2 * s.tau0 * s.tau0, cuts);
  // R^2 tau^2 - (1 - R^2 slope^2) h^2, tau the radius at the foot: the discriminant along the line.
  const double foot0 = first.tau0 - slope * first.u0, foot1 = first.tau1 - slope * first.u1,
               narrow = 1 - R2 * slope * slope;
  add_roots(R2 * foot1 * foot1 - narrow, R2 * foot0 * foot1, R2 * foot0 * foot0 - narrow * n2, cuts);
  return cuts;
}

/// The integral over all pieces, each by x = middle + half (3 s - s^3) / 2, so that half powers of what vanishes at a
/// cut are smooth: x - begin = half (1 + s)^2 (2 - s) / 2. visit_in(begin, end) is what visits the nodes of a piece;
/// that and agree as of integrate_adaptively(), but the third that agree is told is of all pieces.
template <class Sum, class VisitIn, class Agree>
Sum integrate_between(const Cuts& cuts, const VisitIn& visit_in, const Agree& agree) {
  const auto node_of = [&visit_in](double a, double b) {
    return [visit = visit_in(a, b), middle = (a + b) / 2, half = (b - a) / 2](double s, double weight, Sum& part) {
      visit(middle + half * (0.5 * s * (3 - s * s)), weight * half * (1.5 * (1 - s * s)), part);
    };
  };
  std::array<Sum, Cuts::most_pieces> wholes{};
  Sum estimate, sum;
  std::size_t pieces = 0;
  cuts.for_each_piece([&](double a, double b) {
    wholes[pieces] = over_panel<Sum>(-1, 2, node_of(a, b));
    estimate += wholes[pieces++];
  });
  const auto agree_in_all = [&](const Sum& coarse, const Sum& fine, const Sum& gathered) {
    return agree(coarse, fine, gathered.value > estimate.value ? gathered : estimate);
  };
  pieces = 0;
  cuts.for_each_piece([&](double a, double b) {
    sum += integrate_adaptively<Sum>(-1, 1, wholes[pieces++], node_of(a, b), agree_in_all);
  });
  return sum;
}

}  // namespace marrow
