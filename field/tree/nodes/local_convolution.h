// Local convolution: only the part of the skeleton beside a point counts there, so that folds do not blend.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "field/math/box3.h"
#include "field/tree/node_info.h"
#include "field/tree/nodes/convolution_segment.h"
#include "field/tree/nodes/plane_parameter.h"

namespace marrow {

/// A polyline of convolution segments. A point's place on it is that of the plane through it (plane_parameter.h); what
/// lies within `reach` along the polyline of that place is convolved, nothing else. Of several places the one with the
/// largest field counts. Behind the first and the last plane a point keeps the place of the end.
/// Smooth but where folds meet, as in a union, and where two places merge and vanish: there the field is torn. That is
/// beyond the centre of a bend, as seen from the curve, so outside the surface while radii are smaller than bends.
/// [Angelidis, Jepp, Cani 2002, sec. 4]
struct LocalConvolution {
  static constexpr NodeInfo info{"local_convolution",
                                 "A polyline with the 1/r^3 kernel that blends with itself only along its own length: "
                                 "folds and coils that come near stay apart."};
  std::vector<Vec3d> points;
  std::vector<double> radius{1};
  double reach = 1;

  static void keys(auto&& key) {
    key("points", &LocalConvolution::points, form::Points{.min_count = 2}, "of the polyline, in order");
    key("radius", &LocalConvolution::radius, form::Reals{.min = 0, .min_open = true},
        "of the surface where the polyline is straight and long, or one for each point");
    key("reach", &LocalConvolution::reach, form::positive,
        "length of the polyline to either side of its place that a point sees; some radii, less than a fold is long");
  }
  std::string problem(std::size_t) const;
  Box3 support() const { return {{-Box3::inf, -Box3::inf, -Box3::inf}, {Box3::inf, Box3::inf, Box3::inf}}; }
  /// With l = 2 reach, or the length of all if that is less, the field at the distance d is at most l R^2 / (2 d^3).
  Box3 extent(double level) const;

  template <Number X>
  X value(const Vec3<X>& p) const;

 private:
  double radius_at(std::size_t vertex) const { return radius.size() == 1 ? radius[0] : radius[vertex]; }
  template <Number X>
  X over_box(const PlaneChain& chain, const Vec3<X>& p) const;
  /// The convolution of what is within reach of a place.
  template <Number X>
  X beside(const PlaneChain& chain, const Vec3<X>& p, const X& place) const;
};

template <Number X>
X LocalConvolution::beside(const PlaneChain& chain, const Vec3<X>& p, const X& place) const {
  X sum(0.0);
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const double start = chain.start[k], length = chain.start[k + 1] - start;
    const X begin = max(place - X(reach + start), X(0.0)), end = min(place + X(reach - start), X(length));
    if (!(upper(end) > lower(begin))) continue;
    const ConvolvedPiece<X> piece{
        points[k], chain.along[k], radius_at(k), (radius_at(k + 1) - radius_at(k)) / length, begin, end};
    sum += piece.at(p);
  }
  return sum;
}

template <Number X>
X LocalConvolution::value(const Vec3<X>& p) const {
  const PlaneChain chain(points);
  if constexpr (is_enclosure<X>) {
    return over_box(chain, p);
  } else {
    X most(0.0);
    chain.for_each_place(p, [&](const X& place) { most = max(most, beside(chain, p, place)); });
    return most;
  }
}

/// Bounds of the value at all places first; then slopes at those only that may have the largest, unless one of them can
/// vanish.
template <Number X>
X LocalConvolution::over_box(const PlaneChain& chain, const Vec3<X>& p) const {
  const Vec3<Interval> box{value_of(p.x), value_of(p.y), value_of(p.z)};
  LargestOfPlaces<X> places;
  chain.for_each_group(p, [&](std::span<const PlanePlace<X>> group, bool certain, bool may_tear) {
    places.add(group, certain, may_tear, [&](const X& place) { return beside(chain, box, Interval(value_of(place))); });
  });
  X most(places.value());
  if constexpr (JetNumber<X>) {
    bool first = true;
    places.for_each_that_counts([&](const auto& candidate) {
      const X f = candidate.may_tear ? X(0.0) : beside(chain, p, candidate.place);
      for (std::size_t i = 0; i < most.slope.size(); ++i) {
        const Interval slope = candidate.may_tear ? Interval::everything() : f.slope[i];
        most.slope[i] = first ? slope : hull(most.slope[i], slope);
      }
      first = false;
    });
  }
  return most;
}

}  // namespace marrow
