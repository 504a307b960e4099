// Rays that are likely to find mistakes.
#include "tests/stress/ray_families.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

#include "field/math/elementary.h"
#include "tests/stress/drawing.h"

namespace marrow::test {
namespace {

Ray toward(const Vec3d& from, const Vec3d& to) { return {from, normalize(to - from)}; }

Vec3d eye(Random& random, const StressScene& s) {
  return s.center() + random_direction(random) * (s.size() * random.between(3, 4.5));
}
Vec3d place(Random& random, const StressScene& s) { return s.center() + random.vector(s.size()); }

Ray chord(Random& random, const StressScene& s) { return toward(eye(random, s), place(random, s)); }

UnitVec3 axis(Random& random, const StressScene& s) {
  Vec3d direction{};
  const auto along = static_cast<std::size_t>(random.whole(0, 2));
  direction[along] = random.between(0, 1) < 0.5 ? -1 : 1;
  if (!s.is_odd()) return UnitVec3::unchecked(direction);
  // What rotations leave of 0, of either sign.
  constexpr double almost_none[] = {0, -0.0, 1e-30, -1e-30, 1e-17, -1e-17, 1e-320};
  for (const std::size_t across : {(along + 1) % 3, (along + 2) % 3})
    direction[across] = almost_none[random.whole(0, 6)];
  return UnitVec3::unchecked(direction);
}

Ray through(const Vec3d& place, const UnitVec3& direction, const StressScene& s) {
  return {place - direction * (4 * s.size()), direction};
}

// An end of a segment, or a point.
Vec3d joint_of(Random& random, const BlendField& blend) {
  const auto i = static_cast<std::size_t>(random.whole(0, static_cast<int>(blend.size()) - 1));
  if (i < blend.points.size()) return blend.points.skeletons[i].at;
  const SegmentSkeleton& s = blend.segments.skeletons[i - blend.points.size()];
  return random.between(0, 1) < 0.5 ? s.from : s.to;
}

// Along a segment, exactly in its axis, or through it across, or through a point along an axis; of odd scenes also from
// within it.
Ray in_skeleton(Random& random, const StressScene& scene) {
  const auto& segments = scene.blend().segments.skeletons;
  if (scene.is_odd() && random.between(0, 1) < 0.4)
    return {joint_of(random, scene.blend()), normalize(random_direction(random))};
  if (segments.empty()) return through(joint_of(random, scene.blend()), axis(random, scene), scene);
  const auto i = static_cast<std::size_t>(random.whole(0, static_cast<int>(segments.size()) - 1));
  const UnitVec3 along = normalize(segments[i].to - segments[i].from);
  if (random.between(0, 1) < 0.6) return through(segments[i].from, random.between(0, 1) < 0.5 ? along : -along, scene);
  const Vec3d at = lerp(segments[i].from, segments[i].to, random.between(0, 1));
  return through(at, normalize(cross(along.vec(), random_direction(random))), scene);
}

// Past a skeleton at about its radius.
Ray tangent(Random& random, const StressScene& scene) {
  const BlendField& blend = scene.blend();
  const auto i = static_cast<std::size_t>(random.whole(0, static_cast<int>(blend.size()) - 1));
  SegmentSkeleton s;
  if (i < blend.points.size()) {
    const PointSkeleton& p = blend.points.skeletons[i];
    s = {p.at, p.at, p.radius, p.radius};
  } else {
    s = blend.segments.skeletons[i - blend.points.size()];
  }
  const double at = random.between(0, 1), radius = s.radius_from + (s.radius_to - s.radius_from) * at;
  const UnitVec3 direction = UnitVec3::unchecked(random_direction(random));
  const UnitVec3 aside = normalize(cross(direction.vec(), random_direction(random)));
  return through(lerp(s.from, s.to, at) + aside * (radius * random.between(0.8, 1.2)), direction, scene);
}

// Through a point of a face, an edge or a corner of a cell, along an axis or across. Cells lie at dyadic fractions of
// the boxes that can be asked for.
Ray cell_boundary(Random& random, const StressScene& s) {
  const Box3 box = s.random_cell(random);
  Vec3d target;
  for (std::size_t i = 0; i < 3; ++i) {
    const double kind = random.between(0, 1);
    const double at = kind < 0.8 ? random.whole(0, 16) / 16.0 : random.between(0, 1);
    target[i] = box.lower[i] + box.size()[i] * at;
  }
  if (random.between(0, 1) < 0.6) return through(target, axis(random, s), s);
  // In the plane of a face
  Vec3d direction = random_direction(random);
  if (random.between(0, 1) < 0.5) direction[static_cast<std::size_t>(random.whole(0, 2))] = 0;
  return through(target, normalize(direction), s);
}

Ray focus(Random& random, const StressScene& s) {
  const Vec3d target = s.focus() + random.vector(s.focus_size());
  return random.between(0, 1) < 0.3 ? through(target, axis(random, s), s) : toward(eye(random, s), target);
}

Ray far(Random& random, const StressScene& s) {
  Ray ray = random.between(0, 1) < 0.5 ? chord(random, s) : tangent(random, s);
  ray.origin = ray.origin - ray.direction * (1e5 * s.size());
  return ray;
}

// Between a ray that hits and one that does not, bisected to the end or part of the way.
Ray silhouette(Random& random, const StressScene& s) {
  const Vec3d from = eye(random, s);
  Vec3d hit = s.focus() + random.vector(s.focus_size()), miss = s.center() + random.vector(2 * s.size());
  const auto meets = [&](const Vec3d& target) { return s.surfaces().first_hit(toward(from, target)).has_value(); };
  if (!meets(hit) || meets(miss)) return chord(random, s);
  const int steps = random.whole(8, 32);
  Vec3d middle = hit;
  for (int i = 0; i < steps; ++i) {
    middle = (hit + miss) * 0.5;
    (meets(middle) ? hit : miss) = middle;
  }
  return toward(from, random.between(0, 1) < 0.5 ? hit : miss);
}

// Rays refer to the hits that they leave: those of the last rays are kept.
const SurfaceHit& kept(const SurfaceHit& hit) {
  constexpr std::size_t most = 4096;  // more than go together
  thread_local std::deque<SurfaceHit> hits;
  if (hits.size() == most) hits.pop_front();
  return hits.emplace_back(hit);
}

// Away from a hit, every second one close to the tangent plane, with what is known of the field there or without.
Ray spawned(Random& random, const StressScene& s) {
  const auto hit = s.surfaces().first_hit(random.between(0, 1) < 0.5 ? chord(random, s) : focus(random, s));
  if (!hit) return chord(random, s);
  Vec3d direction = random_direction(random);
  if (dot(direction, hit->normal) < 0) direction = -direction;
  if (random.between(0, 1) < 0.5)
    direction = direction - hit->normal * (dot(direction, hit->normal) * random.between(0.9, 0.9999));
  if (random.between(0, 1) < 0.5) return {hit->outside, normalize(direction)};
  return kept(*hit).leaving(normalize(direction));
}

// Along the surface, or from a place beside it in any direction: from 1e-9 of the distance to the skeleton on to either
// side.
Ray beside_surface(Random& random, const StressScene& s, const SurfaceHit& hit) {
  const double away = s.oracle().skeleton_distance(hit.position) * pow(10, random.between(-9, -1));
  const Vec3d normal = hit.normal.vec(), p = hit.position + normal * (random.between(0, 1) < 0.5 ? away : -away);
  const Vec3d direction = random_direction(random), flat = direction - normal * dot(direction, normal);
  if (random.between(0, 1) < 0.5) return {p, normalize(direction)};
  return through(p, normalize(flat), s);
}

// Beginning as nearly on the exact surface as a double can tell, on either side of it, at about a right angle or in the
// tangent plane; of odd scenes also farther away.
Ray on_surface(Random& random, const StressScene& s) {
  const Ray ray = random.between(0, 1) < 0.5 ? chord(random, s) : focus(random, s);
  const auto hit = s.surfaces().first_hit(ray);
  if (!hit) return chord(random, s);
  if (s.is_odd() && random.between(0, 1) < 0.7) return beside_surface(random, s, *hit);
  Vec3d p = hit->position;
  for (int i = 0; i < 3; ++i) {
    const BlendSample here = evaluate(s.blend(), p);
    p = p - here.corrected_gradient * ((here.corrected - 1) / length_squared(here.corrected_gradient));
  }
  if (!(length(p - hit->position) < 1e-3 * s.size())) p = hit->position;
  const Vec3d normal = hit->normal.vec(), direction = random_direction(random);
  const bool tangential = random.between(0, 1) < 0.5;
  const Vec3d flat = direction - normal * dot(direction, normal);
  return {p, normalize(tangential ? flat : direction)};
}

// From or to a place at, before or behind its first hit.
Ray cut_at_hit(Random& random, const StressScene& s, Ray ray) {
  const auto hit = s.surfaces().first_hit(ray);
  if (!hit) return ray;
  const double behind = hit->t + s.size() * power_of_ten(random, -12, -0.3);
  switch (random.whole(0, 7)) {
    case 0:
      ray.t_min = ray.t_max = hit->t;
      break;
    case 1:
      ray.t_max = hit->t;
      break;
    case 2:
      ray.t_max = std::nextafter(hit->t, 0);
      break;
    case 3:
      ray.t_min = hit->t;
      break;
    case 4:
      ray.t_min = behind;
      break;
    case 5:
      ray.t_min = behind;
      ray.t_max = behind + s.size() * power_of_ten(random, -9, 0);
      break;
    case 6:
      ray.t_min = ray.t_max = behind;
      break;
    default:
      return {ray.at(behind), UnitVec3::unchecked(random_direction(random))};
  }
  return ray;
}

// In nearly the same direction; all but along the axis that it goes along most, now and then.
Ray neighbour(Random& random, Ray ray) {
  constexpr double almost_none[] = {0, -0.0, 1e-17, -1e-17, 1e-18, -9e-19, 1e-30, -1e-30, -1e-320};
  if (random.between(0, 1) < 0.8) {
    ray.direction = normalize(ray.direction.vec() + random.vector(power_of_ten(random, -9, -2)));
    return ray;
  }
  Vec3d d = ray.direction.vec();
  for (std::size_t k = 0; k < 3; ++k)
    d[k] = std::fabs(d[k]) == max_component(abs(ray.direction.vec())) ? std::copysign(1, d[k])
                                                                      : almost_none[random.whole(0, 8)];
  ray.direction = UnitVec3::unchecked(d);
  return ray;
}

}  // namespace

std::vector<Ray> company_of(Random& random, const StressScene& s) {
  const auto count = static_cast<std::size_t>(random.whole(3, 200));
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const double kind = random.between(0, 1);
    if (kind < 0.1 && !rays.empty()) {
      rays.push_back(rays[static_cast<std::size_t>(random.whole(0, static_cast<int>(rays.size()) - 1))]);
      continue;
    }
    Ray ray = ray_of(static_cast<Family>(random.whole(0, static_cast<int>(family_count) - 1)), random, s);
    if (kind > 0.6) ray = cut_at_hit(random, s, ray);
    rays.push_back(ray);
    if (kind > 0.5)
      for (int i = random.whole(1, 20); i > 0; --i) rays.push_back(neighbour(random, ray));
  }
  return rays;
}

Ray ray_of(Family family, Random& random, const StressScene& scene) {
  switch (family) {
    case Family::Chord:
      return chord(random, scene);
    case Family::Axis:
      return through(
          random.between(0, 1) < 0.5 ? place(random, scene) : scene.focus() + random.vector(scene.focus_size()),
          axis(random, scene), scene);
    case Family::Joint:
      return toward(eye(random, scene), joint_of(random, scene.blend()));
    case Family::Skeleton:
      return in_skeleton(random, scene);
    case Family::Tangent:
      return tangent(random, scene);
    case Family::CellBoundary:
      return cell_boundary(random, scene);
    case Family::Focus:
      return focus(random, scene);
    case Family::Far:
      return far(random, scene);
    case Family::Silhouette:
      return silhouette(random, scene);
    case Family::Surface:
      return on_surface(random, scene);
    case Family::Spawned:
      return spawned(random, scene);
  }
  return chord(random, scene);
}

}  // namespace marrow::test
