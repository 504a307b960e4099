// Up to sixteen rays side by side: what neighbouring pixels ask, and what one vector instruction answers.
#pragma once

#include <bit>
#include <cstddef>
#include <span>

#include "field/math/ray.h"

namespace marrow {

struct RayPacket {
  static constexpr int size = 16;

  alignas(64) double origin[3][size] = {};
  alignas(64) double direction[3][size] = {};  ///< unit vectors
  alignas(64) double t_min[size] = {};
  alignas(64) double t_max[size] = {};

  RayPacket() = default;
  /// At most `size` rays; the other lanes stay 0 and are not to be asked for.
  explicit RayPacket(std::span<const Ray> rays) {
    for (std::size_t lane = 0; lane < rays.size(); ++lane) set(lane, rays[lane]);
  }

  void set(std::size_t lane, const Ray& ray) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      origin[axis][lane] = ray.origin[axis];
      direction[axis][lane] = ray.direction.vec()[axis];
    }
    t_min[lane] = ray.t_min;
    t_max[lane] = ray.t_max;
  }
  /// The ray of a lane, to the same bits.
  Ray ray(std::size_t lane) const {
    const auto at = [lane](const double(&axes)[3][size]) { return Vec3d{axes[0][lane], axes[1][lane], axes[2][lane]}; };
    return {at(origin), UnitVec3::unchecked(at(direction)), t_min[lane], t_max[lane]};
  }
};

/// Calls body(lane) for each lane of a set, the lowest bit that of lane 0.
template <class Body>
void for_each_lane(unsigned rays, const Body& body) {
  for (unsigned left = rays; left != 0; left &= left - 1) body(static_cast<std::size_t>(std::countr_zero(left)));
}

}  // namespace marrow
