// Near pieces as quadrature nodes, in the coordinates of a block.
#pragma once

#include <functional>

#include "field/math/box3.h"
#include "field/trace/sources/near_far.h"
#include "field/trace/sources/pieces.h"
#include "field/trace/sources/source_groups.h"

namespace marrow {

/// Finds rules for what pieces are to the field of a cube, with certified errors.
class RuleFinder {
 public:
  RuleFinder(const PieceCutter&, const NearFar& precision, const Vec3d& center, double half);
  /// Calls found(part, nodes) for the parts of a curve, first to last, and adds their errors. `share`: of the budget of
  /// a piece, what each part may cause.
  void find(const Piece& whole, double share, const std::function<void(const Piece& part, int nodes)>& found);

  double f_error = 0, gradient_error = 0;

 private:
  const PieceCutter& cutter_;
  const NearFar& precision_;
  Vec3d center_;
  double half_;
  Box3 box_;
};

/// Adds what pieces are to the field of a cube.
class SourceEmitter {
 public:
  SourceEmitter(const PieceCutter& cutter, const NearFar& precision, const Vec3d& center, double half)
      : rules(cutter, precision, center, half), degree_(precision.degree()), center_(center), half_(half) {}
  void emit(const Piece&, double share = 1);

  RuleFinder rules;  ///< with the errors
  SourceGroups curves, points;

 private:
  int degree_;
  Vec3d center_;
  double half_;
};

/// A part of a curve, one that does not lean, in the coordinates of a cube.
CurvePiece curve_piece(const Piece&, int nodes, const Vec3d& center, double half, int degree);

}  // namespace marrow
