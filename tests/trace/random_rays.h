// Rays that are likely to find mistakes.
#pragma once

#include <algorithm>

#include "field/math/ray.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {

inline Ray between(const Vec3d& from, const Vec3d& to) { return {from, normalize(to - from)}; }

/// A chord of a ball around the scene, from outside.
inline Ray chord(Random& random) {
  return between(random_direction(random) * random.between(5, 7), random.vector(1.6));
}

/// Parallel to an axis.
inline Ray along_axis(Random& random) {
  Vec3d origin = random.vector(1.6), direction{};
  const auto axis = static_cast<std::size_t>(random.whole(0, 2));
  const double side = random.between(0, 1) < 0.5 ? -1 : 1;
  origin[axis] = 6 * side;
  direction[axis] = -side;
  return {origin, UnitVec3::unchecked(direction)};
}

/// Through an end of a segment or through a point, where pieces join.
inline Ray through_joint(Random& random, const BlendField& blend) {
  const auto pick = [&](std::size_t size) {
    return static_cast<std::size_t>(random.whole(0, static_cast<int>(size) - 1));
  };
  const Vec3d target = !blend.points.empty() && random.between(0, 1) < 0.3
                           ? blend.points.skeletons[pick(blend.points.size())].at
                           : blend.segments.skeletons[pick(blend.segments.size())].to;
  return between(random_direction(random) * 6, target);
}

/// Past a skeleton at about its radius.
inline Ray tangent(Random& random, const BlendField& blend) {
  const auto i = static_cast<std::size_t>(random.whole(0, static_cast<int>(blend.segments.size()) - 1));
  const SegmentSkeleton& s = blend.segments.skeletons[i];
  const double at = random.between(0, 1);
  const Vec3d direction = random_direction(random);
  const UnitVec3 aside = normalize(cross(direction, random_direction(random)));
  const double radius = s.radius_from + (s.radius_to - s.radius_from) * at;
  const Vec3d target = lerp(s.from, s.to, at) + aside * (radius * random.between(0.8, 1.2));
  return {target - direction * 6.0, UnitVec3::unchecked(direction)};
}

/// The same ray begun `distance` further back.
inline Ray from_afar(Ray ray, double distance) {
  ray.origin = ray.origin - ray.direction * distance;
  return ray;
}

inline Ray any_ray(Random& random, const BlendField& blend) {
  switch (random.whole(0, 5)) {
    case 0:
      return along_axis(random);
    case 1:
      return through_joint(random, blend);
    case 2:
      return tangent(random, blend);
    case 3:
      return from_afar(chord(random), 1e5);
    default:
      return chord(random);
  }
}

}  // namespace marrow::test
