// A line with round ends, of one radius or of two.
#pragma once

#include <string>
#include <vector>

#include "field/tree/distances.h"
#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The hull of two balls; the distance is exact.
struct LineSolid {
  static constexpr NodeInfo info{"line", "A line with round ends and a bounded field."};
  Vec3d from{0, -1, 0}, to{0, 1, 0};
  std::vector<double> radius{0.25};
  Potential potential;

  static void keys(auto&& key) {
    key("from", &LineSolid::from, form::Position{}, "one end");
    key("to", &LineSolid::to, form::Position{}, "the other end");
    key("radius", &LineSolid::radius, form::Reals{.min = 0, .min_open = true}, "of its surface, or [at from, at to]");
    key("potential", &LineSolid::potential, form::OneOf{}, "how the field falls");
  }
  std::string problem(std::size_t) const { return radius.size() > 2 ? "radius must be one number or two" : ""; }
  Box3 support() const;

  template <Number X>
  X value(const Vec3<X>& p) const {
    const double span = length(to - from), shrink = radius.front() - radius.back();
    if (std::fabs(shrink) >= span) return bounded_field(potential, larger_ball(p));
    const FromAxis<X> q = from_axis(p, from, normalize(to - from));
    const double sine = shrink / span;
    return bounded_field(potential, distance(q.radius, q.along, sine, span));
  }

 private:
  template <Number X>
  X larger_ball(const Vec3<X>& p) const {
    const bool first = radius.front() >= radius.back();
    return length(p - (first ? from : to)) - (first ? radius.front() : radius.back());
  }
  /// In the plane of the axis: along the straight side, which leans by asin(sine), and across it. Beyond either end of
  /// the side the ball there is nearest.
  template <Number X>
  X distance(const X& r, const X& z, double sine, double span) const {
    const double cosine = std::sqrt(1 - sine * sine);
    const X across = r * cosine + z * sine, along = z * cosine - r * sine;
    const X from_line = piecewise(
        along, 0, [&](const X& before) { return length(across, before); },
        [&](const X& on) {
          return piecewise(
              on, cosine * span, [&](const X&) { return across; },
              [&](const X& after) { return length(across - sine * span, after - cosine * span) + sine * span; });
        });
    return from_line - radius.front();
  }
};

}  // namespace marrow
