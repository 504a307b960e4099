// Spheres and planes with exact intersections, to test light transport without fields.
#pragma once

#include <limits>
#include <vector>

#include "renderer/geometry/surfaces.h"

namespace marrow {

class MockSurfaces final : public Surfaces {
 public:
  struct Sphere {
    Vec3d center;
    double radius = 1;
    MaterialId material{0};
    bool inward = false;  ///< a cave: its inside is what light sees
  };
  struct Plane {
    Vec3d point;
    UnitVec3 normal;
    MaterialId material{0};
  };

  explicit MockSurfaces(std::vector<Sphere> spheres, std::vector<Plane> planes = {})
      : spheres_(std::move(spheres)), planes_(std::move(planes)) {}

  using Surfaces::first_hit;
  std::optional<SurfaceHit> first_hit(const Ray& ray, RayRecord& record) const override {
    std::optional<SurfaceHit> nearest;
    const auto offer = [&](double t, const UnitVec3& normal, MaterialId material, std::size_t object) {
      if (!(t >= ray.t_min && t <= ray.t_max) || (nearest && nearest->t <= t)) return;
      const Vec3d p = ray.at(t);
      nearest = SurfaceHit{t, p, normal, p + normal * 1e-9, ObjectId(object), material, {}};
      record.evaluations = 1;
    };
    for (std::size_t i = 0; i < spheres_.size(); ++i)
      if (const double t = entry(ray, spheres_[i]); t < infinity)
        offer(t, normalize((ray.at(t) - spheres_[i].center) * (spheres_[i].inward ? -1.0 : 1.0)), spheres_[i].material,
              i);
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const double cosine = dot(planes_[i].normal, ray.direction);
      if (cosine < 0)
        offer(dot(planes_[i].normal, planes_[i].point - ray.origin) / cosine, planes_[i].normal, planes_[i].material,
              spheres_.size() + i);
    }
    return nearest;
  }
  bool occluded(const Ray& ray) const override { return first_hit(ray).has_value(); }
  Box3 bounds() const override {
    Box3 box;
    for (const Sphere& s : spheres_) box.include(Box3{s.center, s.center}.padded(s.radius));
    return box;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  // Where the ray goes from the lit side to the other: the near root of a ball, the far one of a cave.
  static double entry(const Ray& ray, const Sphere& s) {
    const Vec3d to_center = s.center - ray.origin;
    const double middle = dot(to_center, ray.direction);
    const double half2 = s.radius * s.radius - length_squared(to_center - ray.direction * middle);
    if (half2 < 0) return infinity;
    return s.inward ? middle + std::sqrt(half2) : middle - std::sqrt(half2);
  }

  std::vector<Sphere> spheres_;
  std::vector<Plane> planes_;
};

}  // namespace marrow
