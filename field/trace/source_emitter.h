// Near pieces as quadrature nodes, in the coordinates of a block.
#pragma once

#include <cstdint>
#include <vector>

#include "field/math/box3.h"
#include "field/trace/near_far.h"
#include "field/trace/pieces.h"
#include "field/trace/source_groups.h"

namespace marrow {

/// The part of a piece from `position` to `position` + 1 over 2^halvings, and how many nodes stand for it.
struct PieceRule {
  std::uint32_t piece;
  std::uint16_t position;
  std::uint8_t halvings, nodes;
};

/// Adds what pieces are to the field of a cube, with certified errors.
class SourceEmitter {
 public:
  SourceEmitter(const PieceCutter&, const NearFar& precision, int degree, const Vec3d& center, double half);
  /// `rules`, when not null: grow by what is done with the piece, which goes by that index.
  void emit(const Piece&, std::uint32_t index = 0, std::vector<PieceRule>* rules = nullptr);
  /// The same sources, from one of these rules; their errors are not added again.
  void emit_again(const Piece&, const PieceRule&);

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
