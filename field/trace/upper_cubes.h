// The cubes from the root down to the tiles of the first level, and what they see.
#pragma once

#include <cstddef>
#include <deque>

#include "field/trace/divider.h"
#include "field/trace/lazy.h"
#include "field/trace/near_far.h"

namespace marrow {

/// Of the half side of a cube: groups up to this size are passed on unopened to the cubes inside it.
inline constexpr double largest_fine_group = 0.25, largest_coarse_group = 0.5;

/// What an octant of a cube sees; without a parent: what a cube sees of all sources.
Surroundings refined(const NearFar&, const SourceTree&, const Surroundings* parent, int octant, const Vec3d& center,
                     double half, double keep);

/// A cube whose octants are such cubes, tiles of the first level, or hold nothing.
struct UpperCube {
  Vec3d center;
  double half;
  const UpperCube* parent;  ///< null: the root
  int octant;               ///< of the parent
  Lazy<Surroundings> coarse{}, fine{};
};

/// What upper cubes see is made when the first tile below asks for it, so that no tile goes through all sources of the
/// blend. Safe to use from many threads, but for add() and clear(). Refers to what it is made of.
class UpperCubes {
 public:
  UpperCubes(const SourceTree&, const NearFar& coarse, const NearFar& fine, const BlockKernels&);

  /// The result stays where it is. `parent`: null for the root.
  const UpperCube& add(const CubeView&, const UpperCube* parent, int octant);
  void clear() { cubes_.clear(); }

  const Surroundings& coarse_around(const UpperCube&) const;
  const Surroundings& fine_around(const UpperCube&) const;
  std::size_t bytes() const;

 private:
  const SourceTree& sources_;
  const NearFar& coarse_;
  NearFar fine_;  // to a part of the errors of tiles
  std::deque<UpperCube> cubes_;
};

}  // namespace marrow
