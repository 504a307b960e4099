// Local convolution: only the part of the skeleton beside a point counts there, so that folds do not blend.
#pragma once

#include <algorithm>
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
  double largest_radius() const { return *std::ranges::max_element(radius); }
  /// The field within rho of a point, of the polyline beside a place of it; infinite where it may be as near.
  double at_most(const PlaneChain& chain, double widest, const Vec3d& p, double rho, const Interval& place) const;
  /// The convolution of what is within reach of a place.
  template <Number X>
  X beside(const PlaneChain& chain, const Vec3<X>& p, const X& place) const;
};

template <Number X>
X LocalConvolution::beside(const PlaneChain& chain, const Vec3<X>& p, const X& place) const {
  X sum(0.0);
  const auto [first, last] = chain.edges_within(lower(place) - reach, upper(place) + reach);
  for (std::size_t k = first; k < last; ++k) {
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
    const Vec3d at{lower(p.x), lower(p.y), lower(p.z)};
    const double widest = largest_radius();
    X most(0.0);
    chain.for_each_place(p, [&](const X& place) {
      if (at_most(chain, widest, at, 0, Interval(lower(place))) > lower(most))
        most = max(most, beside(chain, p, place));
    });
    return most;
  }
}

/// Bounds of the value at all places that may have the largest first; then slopes at those, unless one of them can
/// vanish.
template <Number X>
X LocalConvolution::over_box(const PlaneChain& chain, const Vec3<X>& p) const {
  const Vec3<Interval> box{value_of(p.x), value_of(p.y), value_of(p.z)};
  const Vec3d center{box.x.middle(), box.y.middle(), box.z.middle()};
  const double rho = 0.5 * length(Vec3d{box.x.width(), box.y.width(), box.z.width()}) * (1 + 1e-9),
               widest = largest_radius();
  LargestOfPlaces places;
  chain.for_each_group(box, [&](std::span<const PlanePlace<Interval>> group, bool certain, bool may_tear) {
    places.add(group, certain, may_tear,
               [&](const Interval& place) { return at_most(chain, widest, center, rho, place); });
  });
  places.settle([&](const Interval& place) { return beside(chain, box, place); }, JetNumber<X>);
  X most(places.value());
  if constexpr (JetNumber<X>) {
    if (most.value.hi == Box3::inf) {
      most.slope.fill(Interval::everything());
      return most;
    }
    bool first = true;
    const auto include = [&](std::size_t i, const Interval& slope) {
      most.slope[i] = first ? slope : hull(most.slope[i], slope);
    };
    places.for_each_that_counts([&](const LargestOfPlaces::Candidate& candidate) {
      bool is_known = false;
      const auto add = [&](const X& place) {
        const X f = beside(chain, p, place);
        for (std::size_t i = 0; i < most.slope.size(); ++i) include(i, f.slope[i]);
        is_known = true;
        first = false;
      };
      if (candidate.place.edge == PlaneChain::no_edge) add(X(candidate.place.at));
      else if (!candidate.may_tear)
        chain.places_on_edge(p, candidate.place.edge, [&](const PlanePlace<X>& place) { add(place.at); });
      if (is_known && !candidate.may_tear) return;
      for (std::size_t i = 0; i < most.slope.size(); ++i) include(i, Interval::everything());
      first = false;
    });
  }
  return most;
}

}  // namespace marrow
