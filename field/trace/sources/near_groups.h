// Near sources of a cube, lane by lane, as the kernel for bounds of octants reads them.
#pragma once

#include <span>
#include <vector>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/sources/source_tree.h"

namespace marrow {

/// Curves, then points, in the coordinates of the cube. Lanes without a source have no field.
class NearGroups {
 public:
  NearGroups(const SourceTree&, std::span<const SourceRef> near, const Vec3d& center, double half);
  /// Of those of some pieces that are points, or curves.
  NearGroups(std::span<const Piece>, std::span<const std::uint32_t> near, bool points, const Vec3d& center,
             double half);

  const float* data() const { return groups_.empty() ? nullptr : groups_.front().from[0]; }
  int count() const { return static_cast<int>(groups_.size()); }
  int curve_groups() const { return curve_groups_; }
  int point_groups() const { return static_cast<int>(groups_.size()) - curve_groups_; }
  bool some_lean() const { return some_lean_; }  ///< of their pieces

 private:
  struct alignas(64) Group {
    float from[3][lanes], along[3][lanes], inverse_length2[lanes], share[lanes], taper[lanes], tau[lanes],
        length[lanes], reach[lanes], thinnest[lanes], lean[lanes];
  };
  static_assert(sizeof(Group) == floats_per_piece_group * sizeof(float));

  struct Lane {
    Group& group;
    std::size_t at;
  };
  Lane next_lane();
  void add(const Piece&);
  void add(const SourceNode&);

  Vec3d center_;
  double scale_;
  bool some_lean_ = false;
  int curve_groups_ = 0, used_ = 0;  // lanes used of the last group
  std::vector<Group> groups_;
};

}  // namespace marrow
