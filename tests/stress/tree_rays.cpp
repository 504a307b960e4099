// Rays that are likely to find mistakes, for one scene of a general tree.
#include "tests/stress/tree_rays.h"

#include <cmath>

#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

bool maybe(Random& random, double share = 0.5) { return random.between(0, 1) < share; }

AimedRay toward(const Vec3d& from, const Vec3d& to) { return {{from, normalize(to - from)}, length(to - from)}; }

Vec3d eye(Random& random, const TreeScene& s) {
  return s.center() + random_direction(random) * (s.size() * random.between(2, 4));
}
Vec3d in_some_cell(Random& random, const TreeScene& s) { return random_in(random, s.random_cell(random)); }

AimedRay chord(Random& random, const TreeScene& s) { return toward(eye(random, s), in_some_cell(random, s)); }

UnitVec3 axis(Random& random) {
  Vec3d direction{};
  direction[static_cast<std::size_t>(random.whole(0, 2))] = maybe(random) ? -1 : 1;
  return UnitVec3::unchecked(direction);
}
UnitVec3 any_direction(Random& random) { return UnitVec3::unchecked(random_direction(random)); }

AimedRay through(const Vec3d& place, const UnitVec3& direction, const TreeScene& s) {
  const double back = 3 * s.size() + length(place - s.center());
  return {{place - direction * back, direction}, back};
}

// Along an axis, in a plane of two, or anywhere.
UnitVec3 some_direction(Random& random) {
  if (maybe(random)) return axis(random);
  Vec3d direction = random_direction(random);
  if (maybe(random)) direction[static_cast<std::size_t>(random.whole(0, 2))] = 0;
  return normalize(direction);
}

Vec3d near_focus(Random& random, const TreeScene& s) {
  return s.random_focus(random) + random.vector(s.focus_size() * pow(10, random.between(-4, 0)));
}

AimedRay axis_parallel(Random& random, const TreeScene& s) {
  return through(maybe(random) ? in_some_cell(random, s) : near_focus(random, s), axis(random), s);
}

// Through a point of a face, an edge or a corner of a cell, along an axis, in the plane of a face, or across.
AimedRay cell_boundary(Random& random, const TreeScene& s) {
  const Box3 box = s.random_cell(random);
  Vec3d target;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = maybe(random, 0.8) ? random.whole(0, 16) / 16.0 : random.between(0, 1);
    target[i] = box.lower[i] + box.size()[i] * at;
  }
  return through(target, some_direction(random), s);
}

AimedRay far(Random& random, const TreeScene& s) {
  AimedRay r = maybe(random) ? chord(random, s) : toward(eye(random, s), near_focus(random, s));
  r.ray.origin = r.ray.origin - r.ray.direction * (1e5 * s.size());
  r.aim += 1e5 * s.size();
  return r;
}

std::optional<SurfaceHit> some_hit(Random& random, const TreeScene& s) {
  return s.surfaces().first_hit((maybe(random) ? chord(random, s) : toward(eye(random, s), near_focus(random, s))).ray);
}

UnitVec3 flat_direction(Random& random, const UnitVec3& normal) {
  return normalize(cross(normal.vec(), random_direction(random)));
}

// Past a hit in its tangent plane, by 1e-10 to a hundredth of the scene to either side.
AimedRay tangent(Random& random, const TreeScene& s) {
  const auto hit = some_hit(random, s);
  if (!hit || !is_finite(hit->normal.vec())) return chord(random, s);
  const double aside = (maybe(random) ? -1 : 1) * s.size() * pow(10, random.between(-10, -2));
  return through(hit->position + hit->normal * aside, flat_direction(random, hit->normal), s);
}

// Between a ray that hits and one that does not, bisected to the end or part of the way.
AimedRay silhouette(Random& random, const TreeScene& s) {
  const Vec3d from = eye(random, s);
  Vec3d hit = maybe(random) ? near_focus(random, s) : in_some_cell(random, s);
  Vec3d miss = s.center() + random.vector(2 * s.size());
  const auto meets = [&](const Vec3d& target) { return s.surfaces().first_hit(toward(from, target).ray).has_value(); };
  if (!meets(hit) || meets(miss)) return chord(random, s);
  Vec3d middle = hit;
  for (int i = random.whole(8, 40); i > 0; --i) {
    middle = (hit + miss) * 0.5;
    (meets(middle) ? hit : miss) = middle;
  }
  return toward(from, maybe(random) ? hit : miss);
}

AimedRay inside(Random& random, const TreeScene& s) {
  Vec3d from = maybe(random) ? near_focus(random, s) : in_some_cell(random, s);
  for (int i = 0; i < 8 && s.value(from) < 1; ++i) from = in_some_cell(random, s);
  return {{from, some_direction(random)}, 0};
}

// Beginning as nearly on the exact surface as a double can tell, on either side of it.
AimedRay on_surface(Random& random, const TreeScene& s) {
  const auto hit = some_hit(random, s);
  if (!hit || !is_finite(hit->normal.vec())) return chord(random, s);
  const Vec3d step = hit->normal * (1e-7 * s.size());
  Vec3d in = hit->position - step, out = hit->position + step;
  if (s.value(in) >= 1 && s.value(out) < 1)
    for (int i = 0; i < 60; ++i) {
      const Vec3d middle = (in + out) * 0.5;
      (s.value(middle) >= 1 ? in : out) = middle;
    }
  return {{maybe(random) ? in : out, maybe(random) ? flat_direction(random, hit->normal) : any_direction(random)}, 0};
}

// Away from a hit, every second one close to the tangent plane.
AimedRay spawned(Random& random, const TreeScene& s) {
  const auto hit = some_hit(random, s);
  if (!hit || !is_finite(hit->normal.vec())) return chord(random, s);
  Vec3d direction = random_direction(random);
  if (dot(direction, hit->normal) < 0) direction = -direction;
  if (maybe(random)) direction = direction - hit->normal * (dot(direction, hit->normal) * random.between(0.9, 0.9999));
  return {{hit->outside, normalize(direction)}, 0};
}

}  // namespace

AimedRay tree_ray(TreeFamily family, Random& random, const TreeScene& s) {
  switch (family) {
    case TreeFamily::Chord:
      return chord(random, s);
    case TreeFamily::Axis:
      return axis_parallel(random, s);
    case TreeFamily::Focus:
      return toward(eye(random, s), near_focus(random, s));
    case TreeFamily::Place:
      return through(s.random_focus(random), some_direction(random), s);
    case TreeFamily::CellBoundary:
      return cell_boundary(random, s);
    case TreeFamily::Far:
      return far(random, s);
    case TreeFamily::Tangent:
      return tangent(random, s);
    case TreeFamily::Silhouette:
      return silhouette(random, s);
    case TreeFamily::Inside:
      return inside(random, s);
    case TreeFamily::Surface:
      return on_surface(random, s);
    case TreeFamily::Spawned:
      return spawned(random, s);
  }
  return chord(random, s);
}

}  // namespace marrow::test
