// Random fields and points for laws, from a fixed seed, which is printed.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>

#include "field/blend/blend_field.h"
#include "field/math/elementary.h"

namespace marrow::test {

/// splitmix64: the same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) { std::cout << "  seed " << seed << '\n'; }
  /// For tests that draw many generators from one seed, and print that.
  struct Silent {};
  Random(std::uint64_t seed, Silent) : state_(seed) {}

  /// One of many streams of numbers that have nothing in common. Seeds that differ by multiples of the step of the
  /// generator would share one stream, shifted.
  static Random stream(std::uint64_t number) {
    Random random(number, Silent{});
    random.state_ = random.next();
    return random;
  }

  double between(double low, double high) { return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53); }
  int whole(int low, int high) { return low + static_cast<int>(between(0, high - low + 1)); }
  Vec3d vector(double extent) {
    const double x = between(-extent, extent), y = between(-extent, extent);
    return {x, y, between(-extent, extent)};
  }
  PointSkeleton point() {
    const Vec3d at = vector(1.6);
    return {at, between(0.3, 0.9)};
  }
  SegmentSkeleton segment() {
    const Vec3d from = vector(1.6), to = vector(1.6);
    const double first = between(0.2, 0.8);
    return {from, to, first, between(0, 1) < 0.3 ? first : between(0.2, 0.8)};
  }
  TriangleSkeleton triangle() {
    TriangleSkeleton t{{vector(1.6), vector(1.6), vector(1.6)}, {}};
    t.radii.fill(between(0.2, 0.8));
    if (between(0, 1) < 0.5) t.radii = {between(0.2, 0.8), between(0.2, 0.8), between(0.2, 0.8)};
    return t;
  }
  ArcSkeleton arc() {
    ArcSkeleton a;
    a.center = vector(1);
    const UnitVec3 first = normalize(vector(1));
    a.axis1 = first.vec();
    a.axis2 = normalize(cross(first.vec(), vector(1))).vec();
    a.major = between(0.3, 2);
    a.begin = between(-4, 4);
    a.end = a.begin + between(0.2, 6.2);
    a.radius_from = between(0.2, 0.8);
    a.radius_to = between(0, 1) < 0.3 ? a.radius_from : between(0.2, 0.8);
    return a;
  }

 private:
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

/// A few primitives of every kind.
inline BlendField random_blend(Random& random, int degree, double alpha, bool cavity, Projection projection) {
  BlendField blend;
  blend.degree = degree;
  blend.alpha = alpha;
  blend.cavity = cavity;
  blend.projection = projection;
  for (int i = 0; i < 2; ++i) {
    blend.points.add(random.point(), {});
    blend.segments.add(random.segment(), {});
  }
  blend.distance_segments.add(random.segment(), {});
  return blend;
}

/// Random primitives and their mirror images in `center`, where G = 0: places near it are in the cavity branch.
inline BlendField mirrored_blend(Random& random, const Vec3d& center, int degree, double alpha, bool cavity,
                                 Projection projection) {
  BlendField blend = random_blend(random, degree, alpha, cavity, projection);
  const auto image = [&](const Vec3d& p) { return center * 2 - p; };
  for (std::size_t i = 0, count = blend.points.size(); i < count; ++i) {
    const PointSkeleton s = blend.points.skeletons[i];
    blend.points.add({image(s.at), s.radius}, {});
  }
  for (auto* list : {&blend.segments, &blend.distance_segments})
    for (std::size_t i = 0, count = list->size(); i < count; ++i) {
      const SegmentSkeleton s = list->skeletons[i];
      list->add({image(s.from), image(s.to), s.radius_from, s.radius_to}, {});
    }
  return blend;
}

/// |a - b| relative to the larger.
inline double relative(double a, double b) {
  const double scale = std::fmax(std::fabs(a), std::fabs(b));
  return scale == 0 ? 0 : std::fabs(a - b) / scale;
}
inline double relative(const Vec3d& a, const Vec3d& b) {
  const double scale = std::fmax(length(a), length(b));
  return scale == 0 ? 0 : length(a - b) / scale;
}

/// Calls look(q) at the places this far beside p, both ways along each axis.
template <class Look>
void for_each_beside(const Vec3d& p, double distance, const Look& look) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double way : {-distance, distance}) {
      Vec3d q = p;
      q[axis] += way;
      look(q);
    }
}

/// Central differences with two steps combined to fourth order.
template <class Field>
Vec3d numeric_gradient(const Field& field, const Vec3d& p, double step) {
  Vec3d gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto difference = [&](double h) {
      Vec3d a = p, b = p;
      a[axis] += h;
      b[axis] -= h;
      return (field(a) - field(b)) / (2 * h);
    };
    gradient[axis] = (4 * difference(step) - difference(2 * step)) / 3;
  }
  return gradient;
}

}  // namespace marrow::test
