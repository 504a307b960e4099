// Points in the coordinates of a node, as the warps above it take them there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "field/blend/bounds/sum/sum_bounds.h"
#include "field/number/functions.h"
#include "field/number/jet.h"

namespace marrow::tree {

/// Where a node is asked for its field: one point, or all points of an enclosure. Of a point that is its coordinates.
template <Number X>
struct Place {
  Vec3<X> p;

  Place() = default;
  Place(const Vec3<X>& at) : p(at) {}
  /// Of the points that a tree is asked for.
  static Place outermost(const Vec3<X>& at) { return at; }
};

/// A piece of a ray (N = 1) or a box (N = 3), or what warps have made of it. Its enclosure says little where it comes
/// out askew. Where its middle comes to, and how places move from there with the variables, tells that a piece of a ray
/// is nearly straight still, and that a box has no longer diagonals than before.
template <std::size_t N>
struct Place<Jet<Interval, N>> {
  static_assert(N == 1 || N == 3);
  using X = Jet<Interval, N>;

  Vec3<X> p;
  Vec3<Interval> middle{};
  std::array<double, N> half{};  ///< from the middle to either end of each variable
  bool knows_middle = false;

  Place() = default;
  Place(const Vec3<X>& at) : p(at) {}
  static Place outermost(const Vec3<X>&);

  /// A node's place from this one, with the middle that a warp has brought its own to: no place is farther from that
  /// than slopes allow.
  Place moved(const Vec3<X>& to, const Vec3<Interval>& middle_to) const;

  Box3 box() const { return {{p.x.value.lo, p.y.value.lo, p.z.value.lo}, {p.x.value.hi, p.y.value.hi, p.z.value.hi}}; }
  /// What holds all places more closely than the box of the enclosure, about the middle of a box of its own; nothing
  /// where that is the closer one.
  struct Part {
    Box3 box;
    std::conditional_t<N == 1, Stretch, SkewBox> shape;
  };
  std::optional<Part> part() const;

 private:
  // Of places on a line, and of what is found from them.
  static constexpr double roundings = 64 * rounding::ulp;

  double largest_coordinate() const {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max({largest, std::fabs(p[i].value.lo), std::fabs(p[i].value.hi)});
    return largest;
  }
  void find_middle_of_line();
  void find_middle_of_box();
};

template <std::size_t N>
Place<Jet<Interval, N>> Place<Jet<Interval, N>>::outermost(const Vec3<X>& at) {
  Place place(at);
  if constexpr (N == 1) place.find_middle_of_line();
  else place.find_middle_of_box();
  return place;
}

// A line has slopes without a width but rounding, and its box has sides as long as these say: it is the diagonal.
template <std::size_t N>
void Place<Jet<Interval, N>>::find_middle_of_line() {
  double speed = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (const double along = std::fabs(p[i].slope[0].middle()); along > speed) {
      speed = along;
      half[0] = 0.5 * p[i].value.width() / along;
    }
  const double slack = roundings * largest_coordinate();
  knows_middle = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Interval &x = p[i].value, &slope = p[i].slope[0];
    middle[i] = Interval(x.middle()) + Interval(-slack, slack);
    const bool is_side = std::fabs(0.5 * x.width() - std::fabs(slope.middle()) * half[0]) <= slack;
    if (!(slope.width() <= roundings * speed) || !is_side) knows_middle = false;
  }
}

// The variables are the coordinates themselves.
template <std::size_t N>
void Place<Jet<Interval, N>>::find_middle_of_box() {
  knows_middle = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Interval& x = p[i].value;
    middle[i] = x.middle();
    half[i] = rounding::up(std::max(x.hi - x.middle(), x.middle() - x.lo));
    for (std::size_t k = 0; k < 3; ++k)
      if (p[i].slope[k] != Interval(i == k ? 1 : 0)) knows_middle = false;
  }
}

template <std::size_t N>
Place<Jet<Interval, N>> Place<Jet<Interval, N>>::moved(const Vec3<X>& to, const Vec3<Interval>& middle_to) const {
  Place place(to);
  place.middle = middle_to;
  place.half = half;
  place.knows_middle = true;
  for (std::size_t i = 0; i < 3; ++i) {
    Interval& x = place.p[i].value;
    Interval by = middle_to[i];
    for (std::size_t k = 0; k < N; ++k) by += to[i].slope[k] * Interval(-half[k], half[k]);
    const Interval both(std::max(by.lo, x.lo), std::min(by.hi, x.hi));
    if (both.lo <= both.hi) x = both;
  }
  return place;
}

template <std::size_t N>
std::optional<typename Place<Jet<Interval, N>>::Part> Place<Jet<Interval, N>>::part() const {
  if (!knows_middle) return {};
  Vec3d center, off;
  for (std::size_t i = 0; i < 3; ++i) {
    center[i] = middle[i].middle();
    off[i] = 0.5 * middle[i].width();
  }
  const double rounded = length(off) + roundings * largest_coordinate();
  std::array<Vec3d, N> direction, turn;
  double slack = rounded;
  Vec3d reach{};
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      direction[k][i] = p[i].slope[k].middle();
      turn[k][i] = 0.5 * p[i].slope[k].width();
    }
    slack += length(turn[k]) * (1 + 1e-12) * half[k];
    reach += abs(direction[k]) * half[k];
  }
  reach += Vec3d{slack, slack, slack};
  Part part{{center - reach, center + reach}, {}};
  const double of_box = 0.5 * length(box().size());
  if constexpr (N == 1) {  // of a straight line both are as long
    part.shape = {direction[0] * half[0], direction[0], slack, length(turn[0]) * (1 + 1e-12)};
    return length(part.shape.half) + slack <= 1.01 * of_box + 2 * rounded ? std::optional(part) : std::nullopt;
  } else {
    part.shape = {{direction[0] * half[0], direction[1] * half[1], direction[2] * half[2]}, slack};
    return part.shape.radius() < 0.99 * of_box ? std::optional(part) : std::nullopt;
  }
}

}  // namespace marrow::tree
