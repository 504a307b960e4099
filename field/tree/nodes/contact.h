// Precise contact: bodies that touch press each other flat instead of blending.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "field/tree/nodes/bulge.h"

namespace marrow {

/// Each body's field f_i becomes F_i = f_i + B(max over the others of f_j), B the contact term of bulge.h, and the
/// whole is the largest F_i. With a the largest field and b the second, that is max(a + B(b), b + B(a)): F_i is largest
/// for the body that has a, or for one that has b. Guaranteed, for any number of bodies: where bodies overlap, F_i = 1
/// exactly on f_i = max f_j, so that deformed bodies touch without gap and do not overlap; a point inside a body stays
/// inside one; around the contact each surface goes on smoothly, for b(1) = 0 and b'(1) = -1; nothing changes where the
/// other fields are below the bulge's `from`; and no surface appears where no body is near, as a bulge is below 1.
/// Where two others are equally near, the bulge of the third has a crease, as those two have against each other. [Cani
/// 1993; Angelidis, Jepp, Cani 2002, sec. 5]
struct Contact {
  static constexpr NodeInfo info{"contact",
                                 "Bodies that press each other flat where they touch, with a bulge around (precise "
                                 "contact modelling). They do not blend.",
                                 2, any_number_of_children};
  Bulge bulge;
  bool first_only = false;

  static void keys(auto&& key) {
    key("bulge", &Contact::bulge, form::OneOf{}, "what rises around the contact");
    key("first_only", &Contact::first_only, form::Switch{},
        "only the first child, as the others deform it: for bodies of different materials, each with its own contact");
  }
  std::string problem(std::size_t) const {
    return std::visit([](const auto& b) { return b.problem(); }, bulge);
  }
  /// Where all fields are below the bulge's end, the value is the largest of them.
  double child_level(double level, std::size_t) const { return std::min(level, from()); }
  /// The body whose deformed field is largest: a bulge is of its body, though it follows the field of the other.
  std::size_t owner(std::span<const double> f) const {
    if (first_only) return 0;
    const std::size_t most = largest(f, f.size()), second = largest(f, most);
    std::size_t best = 0;
    double best_field = -1;
    for (std::size_t i = 0; i < f.size(); ++i) {
      const double field = deformed(bulge, f[i], f[i == most ? second : most]);
      if (field <= best_field) continue;
      best = i;
      best_field = field;
    }
    return best;
  }
  template <Number X>
  X value(std::span<const X> f) const {
    if (first_only) return first(f);
    X most = max(f[0], f[1]), second = min(f[0], f[1]);
    for (const X& x : f.subspan(2)) {
      second = max(second, min(most, x));
      most = max(most, x);
    }
    // Inside two bodies it is never below 1, which two bounds apart from each other would not tell.
    return piecewise(
        second, 1, [&](const X& s) { return max(deformed(bulge, most, s), deformed(bulge, s, most)); },
        [&](const X& s) { return known_within(deformed(bulge, most, s), 1, std::numeric_limits<double>::infinity()); });
  }

  /// Of each body, whether the value depends on it all over these intervals: all others may go at once.
  std::vector<bool> counts(std::span<const Interval> f) const {
    return first_only ? counts_beside_first(f) : counts_of_all(f);
  }

 private:
  double from() const {
    return std::visit([](const auto& b) { return b.from; }, bulge);
  }
  // A body leaves the value as it is where two others are always larger, or where it has no bulge on others and its own
  // deformed field never is the largest.
  std::vector<bool> counts_of_all(std::span<const Interval> f) const {
    std::size_t first = 0, second = 1;
    if (f[1].lo > f[0].lo) std::swap(first, second);
    double most = std::max(f[0].hi, f[1].hi);
    for (std::size_t i = 2; i < f.size(); ++i) {
      most = std::max(most, f[i].hi);
      if (f[i].lo > f[first].lo) second = std::exchange(first, i);
      else if (f[i].lo > f[second].lo) second = i;
    }
    const double bulge_of_largest = contact_term(bulge, Interval(f[first].lo, most)).hi;
    std::vector<bool> counts(f.size(), true);
    for (std::size_t i = 0; i < f.size(); ++i) {
      const bool is_third = i != second && f[i].hi <= f[second].lo;
      const bool is_idle = f[i].hi < from() && (Interval(f[i].hi) + Interval(bulge_of_largest)).hi <= f[first].lo;
      counts[i] = i == first || !(is_third || is_idle);
    }
    return counts;
  }
  // Of the others the largest counts, where it has a bulge.
  std::vector<bool> counts_beside_first(std::span<const Interval> f) const {
    double largest = 0;
    for (const Interval& other : f.subspan(1)) largest = std::max(largest, other.lo);
    std::vector<bool> counts(f.size(), true);
    for (std::size_t i = 1; i < f.size(); ++i) counts[i] = f[i].hi >= from() && f[i].hi >= largest;
    return counts;
  }
  static std::size_t largest(std::span<const double> f, std::size_t but) {
    std::size_t best = but == 0 ? 1 : 0;
    for (std::size_t i = best + 1; i < f.size(); ++i)
      if (i != but && f[i] > f[best]) best = i;
    return best;
  }
  template <Number X>
  X first(std::span<const X> f) const {
    X most = f[1];
    for (const X& x : f.subspan(2)) most = max(most, x);
    return max(deformed(bulge, f[0], most), X(0.0));
  }
};

}  // namespace marrow
