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

// Signed volumes over the edges, each computed from the edge's ends in one order, so that neighbouring triangles
// agree on the side of their common edge and leave no gap (Woop, Benthin, Wald 2013 by other means).
std::optional<double> MeshSolid::hit(std::size_t element, const Ray& ray, bool, ElementLog&) const {
  const auto [a, b, c] = corners(element);
  const Vec3d& d = ray.direction;
  const auto edge = [&](const Vec3d& p, const Vec3d& q) {
    const bool ordered = p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    const Vec3d& first = ordered ? p : q;
    const Vec3d& second = ordered ? q : p;
    const double v = dot(d, cross(first - ray.origin, second - ray.origin));
    return ordered ? v : -v;
  };
  const double u = edge(b, c), v = edge(c, a), w = edge(a, b);
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
  const double sum = u + v + w;
  if (sum == 0) return {};
  const double t = (u * dot(a - ray.origin, d) + v * dot(b - ray.origin, d) + w * dot(c - ray.origin, d)) / sum;
  if (!(t >= ray.t_min && t <= ray.t_max)) return {};
  return t;
}

void MeshSolid::describe(std::size_t element, const void*, const Ray& ray, SurfaceHit& hit) const {
  const auto [a, b, c] = corners(element);
  const UnitVec3 n = normalize(cross(b - a, c - a));
  hit.normal = dot(n, ray.direction) <= 0 ? n : -n;
  hit.outside = lifted(hit.position, hit.normal);
  hit.material = material_;
}

std::size_t MeshSolid::bytes() const {
  return mesh_.positions.size() * sizeof(Vec3d) + mesh_.triangles.size() * sizeof(mesh_.triangles[0]);
}

// A hit computed from |p| <= M is off its plane by some ten roundings, 10 M 2^-53; 2^-46 M is more than ten times that.
Vec3d lifted(const Vec3d& position, const UnitVec3& normal) {
  const double size = std::max(max_component(abs(position)), 1e-30);
  return position + normal * std::ldexp(size, -46);
}

}  // namespace marrow
