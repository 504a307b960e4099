// The strands of a blend with what the cells of its tracer need.
#pragma once

#include <numbers>
#include <utility>

#include "field/trace/cells/strands.h"
#include "tests/trace/stage.h"

namespace marrow::test {

inline constexpr DirectionBounds strand_bounds{0.6, std::numbers::pi / 2};

/// Of strands that may crowd around a cell.
struct Crowd {
  explicit Crowd(BlendField field)
      : stage(std::move(field)), strands(stage.field, stage.sources.pieces(), stage.kernels), context(stage.context) {
    context.strands = &strands;
  }

  Stage stage;
  Strands strands;
  Block::Context context;
};

/// Of the range of angles.
inline double exact_share(const Crowd& crowd, const BlendSample& at) {
  const AngleRange& range = crowd.strands.range();
  return (at.alpha - range.least) / (range.most - range.least);
}

}  // namespace marrow::test
