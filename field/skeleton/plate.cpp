#include "field/skeleton/plate.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace marrow {
namespace {

double distance_from_foot(const Plate::Side& s) {
  const double beyond = std::max({0.0, s.t1, -s.t2});
  return std::sqrt(beyond * beyond + s.inside * s.inside);
}

}  // namespace

std::optional<Plate> plate_seen_from(const TriangleSkeleton& t, const Vec3d& p) {
  Plate plate;
  plate.unit = std::max({t.radii[0], t.radii[1], t.radii[2]});
  std::array<Vec3d, 3> v;
  std::array<double, 3> tau;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = (t.vertices[i] - p) / plate.unit;
    tau[i] = t.radii[i] / plate.unit;
  }
  const Vec3d first = v[1] - v[0], second = v[2] - v[0], area = cross(first, second);
  const double twice_area = length(area);
  if (!(twice_area > 0)) return {};
  plate.normal = area / twice_area;
  plate.height = -dot(v[0], plate.normal);
  double longest = 0, nearest = std::numeric_limits<double>::infinity();
  bool foot_is_inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const double size = length(v[next] - v[i]);
    const Vec3d along = (v[next] - v[i]) / size, out = cross(along, plate.normal);
    Plate::Side& side = plate.sides[i];
    side = {along, out, dot(v[i], along), dot(v[next], along), dot(v[i], out), tau[i], tau[next]};
    longest = std::max(longest, size);
    nearest = std::min(nearest, distance_from_foot(side));
    foot_is_inside = foot_is_inside && side.inside >= 0;
  }
  plate.narrowest = twice_area / longest;
  plate.beside = foot_is_inside ? 0 : nearest;
  plate.taper =
      (cross(second, plate.normal) * (tau[1] - tau[0]) + cross(plate.normal, first) * (tau[2] - tau[0])) / twice_area;
  plate.tau_at_foot = tau[0] - dot(plate.taper, v[0]);
  return plate;
}

}  // namespace marrow
