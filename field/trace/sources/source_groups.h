// Sources gathered lane by lane into the layout that the kernels read.
#pragma once

#include <vector>

#include "field/math/vec3.h"
#include "field/trace/kernels/block_kernels.h"

namespace marrow {

/// Lanes without a source have share 0 and stand far away, at unused_place. `share` is that of FieldLevel, or for
/// far_moments() the field at the origin.
struct alignas(64) SourceGroup {
  float x[lanes], y[lanes], z[lanes], share[lanes], radius[lanes];
};
static_assert(sizeof(SourceGroup) == floats_per_group * sizeof(float));

class SourceGroups {
 public:
  /// A source of this radius, all in one system of coordinates: those of the block.
  void add(const Vec3d& at, double share, double radius) {
    const int lane = count_ % lanes;
    if (lane == 0) start_group();
    SourceGroup& g = groups_.back();
    g.x[lane] = static_cast<float>(at.x);
    g.y[lane] = static_cast<float>(at.y);
    g.z[lane] = static_cast<float>(at.z);
    g.share[lane] = static_cast<float>(share);
    g.radius[lane] = static_cast<float>(radius);
    ++count_;
  }
  /// What comes next begins a group.
  void end_group() { count_ = group_count() * lanes; }
  /// Lanes used, and left out by end_group().
  int count() const { return count_; }
  int group_count() const { return static_cast<int>(groups_.size()); }
  const float* data() const { return groups_.empty() ? nullptr : groups_.front().x; }

 private:
  void start_group() {
    SourceGroup& g = groups_.emplace_back();
    for (int i = 0; i < lanes; ++i) {
      g.x[i] = g.y[i] = g.z[i] = unused_place;
      g.share[i] = g.radius[i] = 0;
    }
  }
  std::vector<SourceGroup> groups_;
  int count_ = 0;
};

}  // namespace marrow
