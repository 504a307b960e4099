// The parts of a tracer, laid open: pieces, errors, tree and blocks of one blend.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "field/trace/blend_tracer.h"
#include "field/trace/cells/block.h"
#include "field/trace/cells/cell_tree.h"
#include "field/trace/cells/precision.h"
#include "tests/trace/far_space.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {

inline IsoCurve guarded(const BlendField& field, IsoCurve iso) {
  expect_far_space_is_dropped(field, iso);
  return iso;
}

struct Stage {
  BlendField field;
  Correction correction;
  IsoCurve iso;
  PieceCutter cutter;
  SourceTree sources;
  const BlockKernels& kernels;
  NearFar coarse, fine;
  mutable BlockArena arena;
  CellTree tree;
  std::vector<CellTree::Cell> cells;
  Block::Context context;

  explicit Stage(BlendField f, std::string_view instruction_set = "")
      : field(std::move(f)),
        correction(correction_of(field)),
        iso(guarded(field, IsoCurve(correction, field.alpha))),
        cutter(field.degree, iso.critical_field()),
        sources(cutter.cut(field), field.degree),
        kernels(*block_kernels(instruction_set)),
        coarse(field.degree, budget_of(coarse_tolerance, field.degree), kernels,
               coarse_far_degree_for(sources.pieces().size())),
        fine(field.degree, budget_of(TraceOptions{}.tolerance, field.degree), kernels,
             fine_far_degree_for(sources.pieces().size())),
        tree(sources, coarse, fine, iso, kernels, field.degree, cells_for(sources.pieces().size())),
        cells(tree.cells()),
        context{sources.pieces(),        tree, cutter, coarse, fine, iso, kernels, field.degree, arena,
                kept_bytes_for(0, false)} {}

  Block block(std::size_t cell) const { return Block(context, cells[cell]); }
  double value(const Vec3d& p) const { return corrected_value(field, p); }
};

}  // namespace marrow::test
