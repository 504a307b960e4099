// Cani and Hornus' convolution segment.
#pragma once

#include <string>
#include <vector>

#include "field/math/box3.h"
#include "field/tree/node_info.h"
#include "field/tree/nodes/inverse_cube.h"

namespace marrow {

/// What a piece of a line adds at p: R^2 / 2 times its integral of 1/r^3. The piece goes from `begin` to `end` along
/// the unit vector `along` from `origin`; R is `radius` + `slope` times the place nearest to p on the piece.
template <Number X>
struct ConvolvedPiece {
  Vec3d origin, along;
  double radius = 1, slope = 0;
  X begin, end;

  /// Nearer than this share of the radius the field stays as it is: 1e18, instead of infinite.
  static constexpr double nearest = 1e-9;

  X at(const Vec3<X>& p) const {
    const Vec3<X> w = p - constant<X>(origin), u = constant<X>(along);
    const X s = dot(w, u);
    const X R = X(radius) + X(slope) * max(begin, min(s, end));
    const Vec3<X> across = w - u * s;
    const X h2 = max(square(across.x) + square(across.y) + square(across.z), X(square(nearest * radius)));
    return square(R) * X(0.5) * inverse_cube_integral(h2, begin - s, end - s);
  }
};

/// f = R(H)^2 (sin a2 - sin a1) / (2 h^2), with the foot H of p on the segment. The field of pieces of one radius put
/// end to end is that of the whole, so that polylines have neither bulges nor creases. An infinite line has its surface
/// at its radius, ends are thinner. With two radii this is not the integral of a radius that varies; the surface only
/// tends to have the radius of the nearest place.   [Cani, Hornus 2001, sec. 4]
struct ConvolutionSegment {
  static constexpr NodeInfo info{"convolution_segment",
                                 "A segment with the 1/r^3 kernel, for `sum` and `restricted_blend`: pieces put end to "
                                 "end join without bulges."};
  Vec3d from{}, to{};
  std::vector<double> radius{1};

  static void keys(auto&& key) {
    key("from", &ConvolutionSegment::from, form::Position{.required = true}, "one end");
    key("to", &ConvolutionSegment::to, form::Position{.required = true}, "the other end");
    key("radius", &ConvolutionSegment::radius, form::Reals{.min = 0, .min_open = true},
        "of its surface where it is long, or two: [at from, at to]");
  }
  std::string problem(std::size_t) const {
    if (radius.empty() || radius.size() > 2) return "radius must be one number or two";
    return from == to ? "from and to must differ" : "";
  }
  Box3 support() const { return {{-Box3::inf, -Box3::inf, -Box3::inf}, {Box3::inf, Box3::inf, Box3::inf}}; }
  /// At the distance d from the segment, of length L, the field is at most R^2 / d^2 and at most L R^2 / (2 d^3).
  Box3 extent(double level) const;

  template <Number X>
  X value(const Vec3<X>& p) const {
    const double length = marrow::length(to - from);
    const ConvolvedPiece<X> piece{
        from, (to - from) / length, radius.front(), (radius.back() - radius.front()) / length, X(0.0), X(length)};
    return piece.at(p);
  }
};

}  // namespace marrow
