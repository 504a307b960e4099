// What a tracer of one blend is made of. For the sources of BlendTracer alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "field/base/serial.h"
#include "field/trace/blend_tracer.h"
#include "field/trace/cells/block.h"
#include "field/trace/cells/cell_tree.h"
#include "field/trace/cells/precision.h"
#include "field/trace/cells/strands.h"
#include "field/trace/curve/largest_gradient.h"
#include "field/trace/curve/shared_iso_curve.h"
#include "field/trace/curve/turned_curve.h"
#include "field/trace/material_search.h"
#include "field/trace/shares/angle_field.h"

namespace marrow {

inline CellTreeSettings cells_of(const TraceOptions& options, std::size_t piece_count) {
  CellTreeSettings settings = options.cells.value_or(cells_for(piece_count));
  if (options.spacing) settings.spacing = options.spacing;
  return settings;
}

// With the angle at which most is inside, where it varies.
inline Correction correction_for(const BlendField& field) {
  const auto range = angle_range(field);
  const double alpha = range ? range->least : single_angle(field).value_or(field.alpha);
  return Correction(field.degree, alpha, field.cavity, field.projection);
}

// Up to what |grad_S f| comes to, but for skeletons shorter than 1e-8 of their radius at degree 3, 1e-5 where the angle
// varies.
inline std::shared_ptr<const IsoCurve> iso_curve_for(const BlendField& field, const Correction& correction,
                                                     const std::optional<AngleRange>& range) {
  constexpr double most_times = 128, most_times_of_ranges = 16;
  const double usual = usual_gradient(correction), largest = largest_gradient(field);
  const auto up_to = [&](double most) { return UpToGradient{std::clamp(largest, usual, most * usual)}; };
  // Of these the curve is level behind the end of its table.
  const bool is_level = correction.projection() == Projection::Exact || correction.alpha() == std::numbers::pi / 2;
  if (range) return shared_iso_curve(correction, range->least, range->most, up_to(is_level ? 1 : most_times_of_ranges));
  return shared_iso_curve(correction, correction.alpha(), correction.alpha(), up_to(is_level ? 1 : most_times));
}

struct BlendTracer::State {
  BlendField field;
  Correction correction;
  std::optional<AngleRange> range;  // of an alpha that varies
  std::shared_ptr<const IsoCurve> shared_iso;
  const IsoCurve& iso;
  PieceCutter cutter;
  SourceTree sources, angle_sources;  // the second one where skeletons have an angle each
  MaterialSearch materials;
  const BlockKernels& kernels;
  std::optional<Strands> strands;  // where their directions give the angle
  NearFar coarse, fine;
  mutable BlockArena arena;
  CellTree tree;
  Block::Context context;
  Box3 bounds;                           // of all tiles
  std::uint64_t serial = next_serial();  // of this tracer

  State(BlendField f, const TraceOptions& options, const BlockKernels& k)
      : field(std::move(f)),
        correction(correction_for(field)),
        range(angle_range(field)),
        shared_iso(iso_curve_for(field, correction, range)),
        iso(*shared_iso),
        cutter(field.degree, iso.critical_field()),
        sources(cutter.cut(field), field.degree),
        angle_sources(
            range && field.alpha_per_skeleton ? angle_pieces(field, *range, cutter.cut(field)) : std::vector<Piece>{},
            field.degree),
        materials(field, sources),
        kernels(k),
        coarse(field.degree, budget_of(coarse_tolerance, field.degree), kernels,
               options.coarse_far_degree.value_or(coarse_far_degree_for(sources.pieces().size()))),
        fine(field.degree, budget_of(options.tolerance, field.degree), kernels,
             options.fine_far_degree.value_or(fine_far_degree_for(sources.pieces().size()))),
        tree(sources, coarse, fine, iso, kernels, field.degree, cells_of(options, sources.pieces().size())),
        context{sources.pieces(),
                tree,
                cutter,
                coarse,
                fine,
                iso,
                kernels,
                field.degree,
                arena,
                options.kept_bytes.value_or(kept_bytes_for(sources.pieces().size(), range && field.alpha_per_skeleton)),
                range && field.alpha_per_skeleton ? &angle_sources : nullptr} {
    if (range && !field.alpha_per_skeleton) {
      strands.emplace(field, sources.pieces(), kernels);
      context.strands = &*strands;
    }
    context.compact_bytes = options.compact_bytes;
    context.eighths = options.eighths.value_or(have_eighths(sources.pieces().size(), options.spacing.get()));
    for (std::size_t i = 0; i < tree.tile_count(); ++i) bounds.include(tree.tile_box(i));
  }

  // |dC/dalpha| <= n - 1 at the surface: |g(f) - G| at alpha = pi/2, with g(1) = n - 1 and G <= 2 g (tips, n = 3);
  // checked numerically for other angles. The share of alpha is a quotient of sums of some 1. What is known of strands
  // is an estimate.
  double largest_error(const BlockLevel& level, const SharePatches* patches) const {
    const double angle_error = level.angle_error + (patches != nullptr ? patches->error() : 0);
    const double range_of_angles = range ? range->most - range->least : 0, steepest = field.degree - 1;
    const double turned = steepest * range_of_angles * (angle_error + level.f_error);
    return level.f_error + level.gradient_error / field.degree + turned;
  }
};

/// Where a ray is in a tile or a slot, to the bits of hit_in() of tiles.
struct BlendTracer::Stretch {
  double enter, exit;
};

/// Whether any hit, if there is one, may as well lie behind the end of its ray: then the first one tells.
inline bool is_at_end(const CellHit& any, double t_max) { return any.block != nullptr && any.t == t_max; }

}  // namespace marrow
