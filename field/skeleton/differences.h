// Second derivatives as differences of the first, where they are not under an integral; internal to skeleton/.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "field/skeleton/radii.h"
#include "field/skeleton/second_order.h"

namespace marrow {

namespace differences {

// Of a radius: what a quadrature is off by, some 1e-12, becomes 1e-9 and 1e-5. Shorter steps are for places beside
// those where the edge of a support touches a skeleton.
inline constexpr double longest_step = 1e-3, shortest_step = 1e-7;

// Differences of the first derivatives at the origin with steps h and 2h, combined to fourth order.
template <class Plain>
SecondOrderSample by_steps(const Plain& plain, double h) {
  SecondOrderSample s;
  const auto first = [](const SkeletonSample& x) {
    return std::array{x.gradient, x.si_jacobian.rows[0], x.si_jacobian.rows[1], x.si_jacobian.rows[2]};
  };
  const SkeletonSample here = plain(Vec3d{});
  const std::array<HessianJet*, 4> jets{&s.field, &s.si.x, &s.si.y, &s.si.z};
  const auto slopes = first(here);
  for (std::size_t q = 0; q < 4; ++q) {
    jets[q]->value = q == 0 ? here.value : here.si_gradient[q - 1];
    jets[q]->slope = {slopes[q].x, slopes[q].y, slopes[q].z};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = [&](double step) {
      Vec3d moved{};
      moved[axis] += step;
      return first(plain(moved));
    };
    const auto ahead = at(h), behind = at(-h), far_ahead = at(2 * h), far_behind = at(-2 * h);
    for (std::size_t q = 0; q < 4; ++q) {
      const Vec3d row = ((ahead[q] - behind[q]) * 8.0 - (far_ahead[q] - far_behind[q])) / (12 * h);
      for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = HessianJet::at[k];
        if (i == axis) jets[q]->curvature[k] += row[j] * 0.5;
        if (j == axis) jets[q]->curvature[k] += row[i] * 0.5;
      }
    }
  }
  return s;
}

inline ArcSkeleton as_seen_from(const Vec3d& p, ArcSkeleton s) {
  s.center = s.center - p;
  return s;
}
inline TriangleSkeleton as_seen_from(const Vec3d& p, TriangleSkeleton s) {
  for (Vec3d& v : s.vertices) v = v - p;
  return s;
}

inline double difference(const SecondOrderSample& a, const SecondOrderSample& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    sum += std::fabs(a.field.curvature[k] - b.field.curvature[k]);
    for (std::size_t c = 0; c < 3; ++c) sum += std::fabs(a.si[c].curvature[k] - b.si[c].curvature[k]);
  }
  return sum;
}

}  // namespace differences

/// By the two neighbouring steps that agree best. Only for arcs and triangles under the compact kernel, whose edge cuts
/// them anywhere: what the edge adds to the derivatives is not under the integral. `field(skeleton, q)` is asked for
/// them as seen from p, with q near 0, so that small steps are exact wherever p is.
template <class Skeleton, class Field>
SecondOrderSample by_differences(const Skeleton& skeleton, const Vec3d& p, const Field& field) {
  using namespace differences;
  const Skeleton seen = as_seen_from(p, skeleton);
  const double radius = least_radius(skeleton);
  const auto plain = [&](const Vec3d& q) { return field(seen, q); };
  constexpr double enough = 1e-9;
  double h = longest_step * radius, least = std::numeric_limits<double>::infinity();
  SecondOrderSample best, longer = by_steps(plain, h);
  while (h > shortest_step * radius) {
    h /= 8;
    const SecondOrderSample shorter = by_steps(plain, h);
    const double off = difference(longer, shorter);
    if (off < least) {
      least = off;
      best = shorter;
    }
    if (off <= enough * difference(shorter, {})) break;
    longer = shorter;
  }
  return best;
}

}  // namespace marrow
