// Certified ray tracing of one blend, in the blend's own coordinates.
//
// The blend's space is divided into cells once; what a cell needs is built when the first ray enters it, and kept.
// A block's content is a function of its cell alone, so pictures do not depend on the order of rays or on threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "field/blend/blend_field.h"
#include "field/math/box3.h"
#include "field/math/ray.h"

namespace marrow {

class Block;

struct TraceOptions {
  std::string instruction_set;  ///< "sse4", "avx2", "avx512"; empty: the best of this machine
  /// Aim for the displacement of the traced surface from the exact one, over the local radius. Error budgets come from
  /// it; TraceStatistics::largest_error tells what is certified.
  double tolerance = 1e-5;
};

struct CellHit {
  double t = 0;
};

/// What a ray did in a cell, hit or not.
struct CellLog {
  double enter = 0;                                            ///< t at which the ray came into the cell
  double undecided = std::numeric_limits<double>::infinity();  ///< t of the first gap too short to decide
  std::uint32_t evaluations = 0;                               ///< of the field
};

struct SurfacePoint {
  UnitVec3 normal;  ///< outward, from the closed-form gradient of the corrected field
  Vec3d outside;    ///< beside the surface, where the field is certainly below the iso-value
};

struct TraceStatistics {
  std::size_t cells = 0, blocks = 0, sources = 0, bytes = 0;
  double largest_error = 0;  ///< of any block so far: certified bound of the corrected field's error
};

/// Safe to use from many threads.
class BlendTracer {
 public:
  /// Errors: an unknown instruction set, or primitives that cannot be traced (distance segments).
  static Result<std::unique_ptr<BlendTracer>> make(BlendField, const TraceOptions&);
  ~BlendTracer();

  std::size_t cell_count() const;
  Box3 cell_box(std::size_t cell) const;

  /// The first root inside a cell with t in [ray.t_min, ray.t_max]; t does not depend on ray.t_max.
  /// With `any`, any root.
  std::optional<CellHit> first_hit(std::size_t cell, const Ray&, bool any, CellLog&) const;
  /// Normal and starting point at a hit in this cell.
  SurfacePoint surface_at(std::size_t cell, const Vec3d& position) const;

  const BlendField& field() const;
  TraceStatistics statistics() const;

 private:
  struct State;
  explicit BlendTracer(std::unique_ptr<State>);
  const Block& block(std::size_t cell) const;
  std::unique_ptr<State> state_;
};

}  // namespace marrow
