#include "renderer/geometry/mesh_solid.h"

#include <algorithm>
#include <cmath>

namespace marrow {

MeshSolid::MeshSolid(const MeshShape& mesh, MaterialId material) : mesh_(mesh), material_(material) {}

std::array<Vec3d, 3> MeshSolid::corners(std::size_t element) const {
  const auto& t = mesh_.triangles[element];
  return {mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]};
}

Box3 MeshSolid::element_box(std::size_t element) const {
  Box3 box;
  for (const Vec3d& p : corners(element)) box.include(p);
  return box;
}

Box3 MeshSolid::extent() const {
  Box3 box;
  for (const Vec3d& p : mesh_.positions) box.include(p);
  return box;
}

namespace {

// Seen along a ray, which becomes the axis at 0: the shear that keeps one axis and turns the direction into it [Woop,
// Benthin, Wald 2013]. A point is where it is for all its triangles, so that neighbours share their edges exactly, and
// no larger than the triangle where the ray passes, however far away the ray begins.
class AlongRay {
 public:
  explicit AlongRay(const Ray& ray) : origin_(ray.origin) {
    const Vec3d d = ray.direction, size = abs(d);
    const double most = max_component(size);
    axis_ = size.x == most ? 0 : size.y == most ? 1 : 2;
    u_ = (axis_ + 1) % 3;
    v_ = (axis_ + 2) % 3;
    inverse_ = 1 / d[axis_];
    shear_u_ = d[u_] * inverse_;
    shear_v_ = d[v_] * inverse_;
  }
  struct Place {
    double u, v, t;
  };
  Place operator()(const Vec3d& point) const {
    const Vec3d p = point - origin_;
    return {p[u_] - shear_u_ * p[axis_], p[v_] - shear_v_ * p[axis_], p[axis_] * inverse_};
  }

 private:
  Vec3d origin_;
  std::size_t axis_, u_, v_;
  double inverse_, shear_u_, shear_v_;
};

// On which side of an edge the ray passes, times twice the area. Rounded products are in the order of the exact ones or
// equal, so the sign is never wrong; 0 counts as both sides.
double side_of(const AlongRay::Place& p, const AlongRay::Place& q) { return p.u * q.v - p.v * q.u; }

}  // namespace

std::optional<double> MeshSolid::hit(std::size_t element, const Ray& ray, bool, ElementLog&) const {
  const auto corner = corners(element);
  const AlongRay seen(ray);
  const AlongRay::Place a = seen(corner[0]), b = seen(corner[1]), c = seen(corner[2]);
  const double u = side_of(b, c), v = side_of(c, a), w = side_of(a, b);
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
  const double sum = u + v + w;
  if (sum == 0) return {};
  const double t = (u * a.t + v * b.t + w * c.t) / sum;
  if (!(t >= ray.t_min && t <= ray.t_max)) return {};
  return t;
}

void MeshSolid::describe(std::span<const HitToDescribe> hits) const {
  for (const auto& [element, place, ray, hit] : hits) {
    const auto [a, b, c] = corners(element);
    const UnitVec3 n = normalize(cross(b - a, c - a));
    hit->normal = dot(n, ray->direction) <= 0 ? n : -n;
    hit->outside = lifted(hit->position, a, hit->normal);
    hit->material = material_;
  }
}

std::size_t MeshSolid::bytes() const {
  return mesh_.positions.size() * sizeof(Vec3d) + mesh_.triangles.size() * sizeof(mesh_.triangles[0]);
}

// Back in the plane a point with coordinates of at most M is off it by some ten roundings, 10 M 2^-53; 2^-46 M is more
// than ten times that. As it comes it is off by what the whole way of its ray rounds.
Vec3d lifted(const Vec3d& position, const Vec3d& in_plane, const UnitVec3& normal) {
  const Vec3d p = position - normal * dot(normal, position - in_plane);
  const double size = std::max({max_component(abs(p)), max_component(abs(in_plane)), 1e-30});
  return p + normal * std::ldexp(size, -46);
}

}  // namespace marrow
