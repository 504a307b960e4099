// Decides what part of a cube may hold surface, from bounds of f and |grad_S f| over its octants.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "field/trace/curve/iso_curve.h"
#include "field/trace/kernels/block_kernels.h"
#include "field/trace/sources/near_far.h"
#include "field/trace/sources/source_tree.h"

namespace marrow {

/// Of the half side of a cube: groups up to this size are passed on unopened to the cubes inside it, and bounds treat
/// them as one. Smaller groups bound more tightly, in longer lists: at 0.2 there are 2 % fewer cells, and dividing
/// takes 1.4 times as long (10^6 segments of neurons).
inline constexpr double largest_coarse_group = 0.5;

/// Of one of the eight half-sized cubes in a cube; `octant` has a bit for each axis, x the lowest.
Vec3d octant_center(const Vec3d& center, double half, int octant);

/// A cube and the sources as it sees them.
struct CubeView {
  Vec3d center;
  double half = 0;
  KeptSurroundings sources;
};

/// Immutable; works with a coarse split, whose errors enter the bounds.
class Divider {
 public:
  Divider(const SourceTree&, const NearFar& coarse, const IsoCurve&, const BlockKernels&, int degree);

  /// A cube outside of which the field is below 1.
  CubeView root() const;

  struct Octant {
    bool mixed = false;       ///< may hold surface; else its field is below 1 all over it, or above 1
    double local_radius = 0;  ///< mean of near pieces, by their field at the centre; infinite where all is far
    double thinnest = std::numeric_limits<double>::infinity();  ///< radius of the thinnest source close by
  };
  std::array<Octant, 8> octants(const CubeView&) const;
  /// One of the eight half-sized cubes.
  CubeView child(const CubeView&, int octant) const;

 private:
  enum class Side { Outside, Inside, Mixed };
  Side side(const OctantBounds&, const FarField::Bounds&) const;
  double influence() const;

  const SourceTree& tree_;
  const NearFar& coarse_;
  const IsoCurve& iso_;
  const BlockKernels& kernels_;
  int degree_;
};

}  // namespace marrow
