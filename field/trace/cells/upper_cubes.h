// The cubes from the root down to the tiles of the first level, and what they see.
#pragma once

#include <cstddef>
#include <deque>

#include "field/base/lazy.h"
#include "field/math/vec3.h"
#include "field/trace/sources/near_far.h"

namespace marrow {

/// As largest_coarse_group, in fine lists.
inline constexpr double largest_fine_group = 0.25;

/// A cube whose octants are such cubes, tiles of the first level, or hold nothing.
struct UpperCube {
  Vec3d center;
  double half;
  const UpperCube* parent;  ///< null: the root
  int octant;               ///< of the parent
  Lazy<KeptSurroundings> coarse{}, fine{};
};

/// What upper cubes see is made when the first tile below asks for it, so that no tile goes through all sources of the
/// blend. Safe to use from many threads, but for add() and clear(). Refers to what it is made of.
class UpperCubes {
 public:
  UpperCubes(const SourceTree&, const NearFar& coarse, const NearFar& fine, const BlockKernels&);

  /// The result stays where it is, until clear(). `parent`: null for the root.
  const UpperCube& add(const Vec3d& center, double half, const UpperCube* parent, int octant);
  void clear() { cubes_.clear(); }

  /// To the errors of `coarse`, and to an eighth of those of `fine`.
  const KeptSurroundings& coarse_around(const UpperCube&) const;
  const KeptSurroundings& fine_around(const UpperCube&) const;
  std::size_t bytes() const;

 private:
  using Seen = Lazy<KeptSurroundings> UpperCube::*;
  const KeptSurroundings& around(const UpperCube&, Seen, const NearFar&, double largest_group) const;

  const SourceTree& sources_;
  const NearFar& coarse_;
  NearFar fine_;  // to a part of the errors of tiles
  std::deque<UpperCube> cubes_;
};

}  // namespace marrow
