// How far apart the rays of a camera are, so that cells that one or two rays meet are not made.
#pragma once

#include <vector>

#include "field/math/vec3.h"

namespace marrow {

/// Of one blend, from everywhere it is placed, in its own coordinates, or of a general tree. A hint: cells are larger
/// where rays are few, and nothing else depends on it.
struct RaySpacing {
  /// Neighbouring rays are `constant + per_distance |p - eye|` apart at p.
  struct View {
    Vec3d eye;
    double constant = 0, per_distance = 0;
  };
  std::vector<View> views;
  /// How often each view's rays come: the samples of a pixel; 0: not known, but more than once.
  int samples = 0;

  /// How far apart the rays of all views together are in a cube, at most (of many thousand views: about): where many
  /// placements share a blend each of its cells is met by the rays of all of them. 0 without views.
  double in_cube(const Vec3d& center, double half) const;
  /// The half side below which a cell in that cube is hardly worth making; 0 without views.
  double least_cell(const Vec3d& center, double half) const;
};

}  // namespace marrow
