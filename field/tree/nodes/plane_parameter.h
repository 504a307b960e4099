// The place of a point on a polyline by planes that turn along it, instead of by its nearest point.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "field/number/functions.h"

namespace marrow {

/// An arc length along a polyline, and whether the point passes from before the plane to behind it there (-1), from
/// behind to before (1), or who knows (0).
template <Number X>
struct PlanePlace {
  X at;
  int crossing;
  std::size_t edge;  ///< on which it is
};

/// A plane at each vertex, half-way between its edges, or across the edge at an end; along an edge the planes between
/// interpolate their origins and normals. A point has the places of all planes that hold it.   [Angelidis et al. 2002]
struct PlaneChain {
  std::span<const Vec3d> points;
  std::vector<Vec3d> along;   ///< of each edge, unit
  std::vector<Vec3d> normal;  ///< of the plane of each vertex, unit
  std::vector<double> start;  ///< arc length at each vertex

  explicit PlaneChain(std::span<const Vec3d> points);
  double length() const { return start.back(); }
  /// All that a stretch of arc lengths meets, and one more on either side, whatever rounding does: from the first up
  /// to, but without, the last.
  std::pair<std::size_t, std::size_t> edges_within(double from, double to) const;

  /// Calls visit(place) for each place of a point, at least one.
  template <Number X, class Visit>
  void for_each_place(const Vec3<X>& p, Visit visit) const;
  /// Calls visit(places, certain, may_tear) with all places that points of a box may have. Of the places of a `certain`
  /// group, every point has one. Where `may_tear`, a place of the group may vanish within the box.
  template <class Visit>
  void for_each_group(const Vec3<Interval>& box, Visit visit) const;
  /// Calls visit(place) for those on one edge alone. Ends of the polyline are not on an edge.
  template <Number X, class Visit>
  void places_on_edge(const Vec3<X>& p, std::size_t edge, Visit visit) const;
  static constexpr std::size_t no_edge = 0xffffffff;

  /// At an arc length.
  Vec3d position(double at) const;

 private:
  // Rounding must not lose a place between two edges.
  static constexpr double slack = 1e-9;

  template <Number X>
  X height(const Vec3<X>& p, std::size_t vertex) const {
    return dot(p - constant<X>(points[vertex]), constant<X>(normal[vertex]));
  }
};

/// Real roots u of a u^2 + b u + c, with the sign of the slope there: c/q and q/a for the q that does not cancel.
template <Number X, class Visit>
void roots_of_quadratic(double a, const X& b, const X& c, Visit visit) {
  const X discriminant = square(b) - X(4 * a) * c;
  if (upper(discriminant) < 0) return;
  const X root = sqrt(max(discriminant, X(0.0)));
  const bool sure = lower(discriminant) > 0;
  if (const int side = lower(b) > 0 ? 1 : upper(b) < 0 ? -1 : 0; side != 0) {
    const X q = X(-0.5) * (b + X(side) * root);
    visit(c / q, sure ? side : 0);
    if (a != 0) visit(q / X(a), sure ? -side : 0);
  } else if (a != 0) {
    visit((root - b) / X(2 * a), sure ? 1 : 0);
    visit((-root - b) / X(2 * a), sure ? -1 : 0);
  } else if constexpr (is_enclosure<X>) {
    X anywhere(Interval(0, 1));
    if constexpr (JetNumber<X>) anywhere.slope.fill(Interval::everything());
    visit(anywhere, 0);
  }
}

/// d(u) . (p - r(u)) = 0 with d and r between those of the edge's ends.
template <Number X, class Visit>
void PlaneChain::places_on_edge(const Vec3<X>& p, std::size_t edge, Visit visit) const {
  const Vec3d dr = points[edge + 1] - points[edge], dd = normal[edge + 1] - normal[edge];
  const Vec3<X> w = p - constant<X>(points[edge]);
  const X b = dot(w, constant<X>(dd)) - X(dot(normal[edge], dr)), c = dot(w, constant<X>(normal[edge]));
  const double length = start[edge + 1] - start[edge];
  roots_of_quadratic(-dot(dd, dr), b, c, [&](const X& u, int crossing) {
    if (!(upper(u) >= -slack && lower(u) <= 1 + slack)) return;
    visit(PlanePlace<X>{X(start[edge]) + X(length) * clamp(u, 0, 1), crossing, edge});
  });
}

template <Number X, class Visit>
void PlaneChain::for_each_place(const Vec3<X>& p, Visit visit) const {
  if (!(lower(height(p, 0)) > 0)) visit(X(0.0));
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    places_on_edge(p, k, [&](const PlanePlace<X>& place) { visit(place.at); });
  if (!(upper(height(p, points.size() - 1)) < 0)) visit(X(length()));
}

/// Between two vertices whose planes the whole box is on different sides of, there is a place for each point; seen from
/// far before, a point is ahead of the first plane, and behind the last seen from far behind.
template <class Visit>
void PlaneChain::for_each_group(const Vec3<Interval>& box, Visit visit) const {
  std::vector<PlanePlace<Interval>> group;
  int before = 1;
  const auto settle = [&](int side) {
    if (side == 0) return;
    bool torn = side == before;
    for (const PlanePlace<Interval>& place : group) torn = torn || place.crossing != side;
    if (!group.empty()) visit(std::span<const PlanePlace<Interval>>(group), side != before, torn);
    group.clear();
    before = side;
  };
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Interval h = height(box, k);
    if (k == 0 && h.lo <= 0) group.push_back({Interval(0), -1, no_edge});
    settle(h.lo > 0 ? 1 : h.hi < 0 ? -1 : 0);
    if (k + 1 < points.size())
      places_on_edge(box, k, [&](const PlanePlace<Interval>& place) { group.push_back(place); });
    else if (h.hi >= 0) group.push_back({Interval(length()), -1, no_edge});
  }
  settle(-1);
}

/// The largest of fields at places of which some may not be there.
class LargestOfPlaces {
 public:
  struct Candidate {
    PlanePlace<Interval> place;
    Interval field;
    bool may_tear;
    std::size_t group;
  };
  /// A group, with at_most(place), which may be infinite, for the field at one.
  template <class AtMost>
  void add(std::span<const PlanePlace<Interval>> group, bool certain, bool may_tear, const AtMost& at_most) {
    for (const PlanePlace<Interval>& place : group)
      all_.push_back({place, Interval(0, at_most(place.at)), may_tear, groups_.size()});
    groups_.push_back({certain ? group.size() : 0, std::numeric_limits<double>::infinity()});
  }
  /// Asks field(place) for bounds, the likely ones first: until no other can raise value(), or, if all that count are
  /// wanted, until no other can have the largest.
  template <class Field>
  void settle(const Field& field, bool all_that_count) {
    std::ranges::stable_sort(all_, std::ranges::greater(), [](const Candidate& c) { return c.field.hi; });
    double most = 0;
    for (Candidate& c : all_) {
      if (c.field.hi < (all_that_count ? sure_ : std::max(sure_, most))) break;
      c.field = field(c.place.at);
      most = std::max(most, c.field.hi);
      Group& group = groups_[c.group];
      group.least = std::min(group.least, c.field.lo);
      if (group.waiting > 0 && --group.waiting == 0) sure_ = std::max(sure_, group.least);
      if (most == std::numeric_limits<double>::infinity()) break;
    }
  }
  Interval value() const {
    Interval most = sure_;
    for (const Candidate& c : all_) most.hi = std::max(most.hi, c.field.hi);
    return most;
  }
  /// Those that may have the largest field.
  template <class Visit>
  void for_each_that_counts(const Visit& visit) const {
    for (const Candidate& c : all_)
      if (c.field.hi >= sure_) visit(c);
  }

 private:
  struct Group {
    std::size_t waiting;  ///< places to be asked before the least of them is sure; 0: it never is
    double least;
  };
  std::vector<Candidate> all_;
  std::vector<Group> groups_;
  double sure_ = 0;
};

}  // namespace marrow
