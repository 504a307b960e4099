// Near pieces as quadrature nodes, in the coordinates of a block.
#pragma once

#include "field/math/box3.h"
#include "field/trace/near_far.h"
#include "field/trace/pieces.h"
#include "field/trace/source_groups.h"

namespace marrow {

/// Adds what pieces are to the field of a cube, with certified errors.
class SourceEmitter {
 public:
  SourceEmitter(const PieceCutter&, const NearFar& precision, int degree, const Vec3d& center, double half);
  void emit(const Piece&);

  SourceGroups curves, points;
  double f_error = 0, gradient_error = 0;

 private:
  const PieceCutter& cutter_;
  const NearFar& precision_;
  int degree_;
  Vec3d center_;
  double half_;
  Box3 box_;
};

}  // namespace marrow
