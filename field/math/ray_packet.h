// Rays side by side, each number of theirs in an array: what vector instructions read.
#pragma once

#include <cstddef>
#include <span>

#include "field/math/lane_set.h"
#include "field/math/ray.h"

namespace marrow {

/// At most `size` rays; other lanes hold anything and are not to be asked for.
struct RayPacket {
  static constexpr int size = packet_size;

  alignas(64) double origin[3][size];
  alignas(64) double direction[3][size];  ///< unit vectors
  alignas(64) double t_min[size];
  alignas(64) double t_max[size];
  const FieldAround* around[size];

  RayPacket() = default;
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
    around[lane] = ray.around;
  }
  /// The ray of a lane, to the same bits.
  Ray ray(std::size_t lane) const {
    const auto at = [lane](const double(&axes)[3][size]) { return Vec3d{axes[0][lane], axes[1][lane], axes[2][lane]}; };
    return {at(origin), UnitVec3::unchecked(at(direction)), t_min[lane], t_max[lane], around[lane]};
  }
};

}  // namespace marrow
