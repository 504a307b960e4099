#include "field/trace/blend_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "field/trace/block.h"
#include "field/trace/cell_tree.h"
#include "field/trace/mask_walk.h"

namespace marrow {
namespace {

// The error of the corrected field is at most error(f) + error(G) / n (dC/df <= 1, dC/dG g'(C) <= 1 with g'(1) = n,
// tracing.md 3.3), and the field falls by about n - 1 over one radius. A block has some 200 sources, most of whose
// error bounds are far below their budget.
ErrorBudget budget_of(double tolerance, int degree) {
  const double share = tolerance * (degree - 1) / 400;
  return {.field = share, .gradient = share * degree};
}

// Of the coarse level: large enough to shorten its lists to a few sources, small enough to bring the fine level
// close to the root at once.
constexpr double coarse_tolerance = 2e-2;

// [t_enter, t_exit] of the ray in a box; the same plane gives the same t in neighbouring cells.
std::pair<double, double> clip(const Box3& box, const Ray& ray) {
  double enter = ray.t_min, exit = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double o = ray.origin[i], d = ray.direction.vec()[i];
    if (d == 0) {
      if (o < box.lower[i] || o > box.upper[i]) return {1, 0};
      continue;
    }
    const double a = (box.lower[i] - o) / d, b = (box.upper[i] - o) / d;
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return {enter, exit};
}

}  // namespace

struct BlendTracer::State {
  BlendField field;
  Correction correction;
  IsoCurve iso;
  PieceCutter cutter;
  std::vector<Piece> pieces;
  NearFar coarse, fine;
  CellTree tree;
  const BlockKernels& kernels;
  mutable std::unique_ptr<std::atomic<const Block*>[]> blocks;

  State(BlendField f, const TraceOptions& options, const BlockKernels& k)
      : field(std::move(f)),
        correction(correction_of(field)),
        iso(correction, field.alpha),
        cutter(field.degree, iso.critical_field()),
        pieces(cutter.cut(field)),
        coarse(field.degree, budget_of(coarse_tolerance, field.degree)),
        fine(field.degree, budget_of(options.tolerance, field.degree)),
        tree(pieces, fine, iso, field.degree, {}),
        kernels(k),
        blocks(new std::atomic<const Block*>[tree.cells().size()]{}) {}
  ~State() {
    for (std::size_t i = 0; i < tree.cells().size(); ++i) delete blocks[i].load();
  }
  Block::Context context() const { return {pieces, tree, cutter, coarse, fine, iso, kernels, field.degree}; }
};

Result<std::unique_ptr<BlendTracer>> BlendTracer::make(BlendField field, const TraceOptions& options) {
  if (!field.distance_segments.empty())
    return failure("`model: distance` can be evaluated (probe, slice) but not rendered by this version");
  const BlockKernels* kernels = block_kernels(options.instruction_set);
  if (kernels == nullptr)
    return failure("instruction set \"" + options.instruction_set + "\" is unknown or not of this machine");
  return std::unique_ptr<BlendTracer>(
      new BlendTracer(std::make_unique<State>(std::move(field), options, *kernels)));
}

BlendTracer::BlendTracer(std::unique_ptr<State> state) : state_(std::move(state)) {}
BlendTracer::~BlendTracer() = default;

std::size_t BlendTracer::cell_count() const { return state_->tree.cells().size(); }
Box3 BlendTracer::cell_box(std::size_t cell) const { return state_->tree.box(state_->tree.cells()[cell]); }
const BlendField& BlendTracer::field() const { return state_->field; }

// Two threads may build the same block; both get the same content, and one copy is kept.
const Block& BlendTracer::block(std::size_t cell) const {
  std::atomic<const Block*>& slot = state_->blocks[cell];
  if (const Block* ready = slot.load(std::memory_order_acquire)) return *ready;
  auto made = std::make_unique<const Block>(state_->context(), state_->tree.cells()[cell]);
  const Block* expected = nullptr;
  if (slot.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *made.release();
  return *expected;
}

std::optional<CellHit> BlendTracer::first_hit(std::size_t cell, const Ray& ray, bool any) const {
  auto [enter, exit] = clip(cell_box(cell), ray);
  if (any) exit = std::min(exit, ray.t_max);
  if (!(enter < exit)) return {};
  const Block& b = block(cell);
  if (b.mask() == 0) return {};
  // Block coordinates, with t counted from the point of the ray nearest to the block's centre.
  const Vec3d& direction = ray.direction;
  const double t_near = dot(b.center() - ray.origin, ray.direction), scale = 1 / b.half();
  const Vec3d start = (ray.origin - b.center() + direction * t_near) * scale;
  const double origin[3] = {start.x, start.y, start.z}, along[3] = {direction.x, direction.y, direction.z};
  LocalRay local;
  for (int i = 0; i < 3; ++i) {
    local.origin[i] = static_cast<float>(origin[i]);
    local.direction[i] = static_cast<float>(along[i]);
  }
  MaskWalk walk(b.mask(), origin, along, (enter - t_near) * scale, (exit - t_near) * scale);
  CellHit hit;
  for (MaskWalk::Stretch s; walk.next(s);) {
    const Root root = state_->kernels.first_root(b.view(), local, static_cast<float>(s.begin),
                                                 static_cast<float>(s.end), any);
    hit.evaluations += static_cast<std::uint32_t>(root.evaluations);
    hit.certified = hit.certified && root.certified;
    if (!root.hit) continue;
    hit.t = std::clamp(t_near + static_cast<double>(root.t) * b.half(), enter, exit);
    return hit.t <= ray.t_max ? std::optional(hit) : std::nullopt;
  }
  return {};
}

SurfacePoint BlendTracer::surface_at(std::size_t cell, const Vec3d& position) const {
  const Block& b = block(cell);
  const auto to_local = [&](const Vec3d& p) {
    const Vec3d x = (p - b.center()) / b.half();
    return std::array<float, 3>{static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
  };
  const PointField f = state_->kernels.point_field(b.view(), to_local(position).data());
  const Vec3d g{f.si_gradient[0], f.si_gradient[1], f.si_gradient[2]};
  const float* h = f.hessian;
  const Vec3d bent{h[0] * g.x + h[3] * g.y + h[4] * g.z, h[3] * g.x + h[1] * g.y + h[5] * g.z,
                   h[4] * g.x + h[5] * g.y + h[2] * g.z};
  const Correction::Partials c = state_->correction.partials(f.f, length(g));
  const Vec3d gradient = Vec3d{f.gradient[0], f.gradient[1], f.gradient[2]} * c.df + bent * c.dG_over_G;
  SurfacePoint out;
  out.normal = normalize(-gradient);
  // Away from the surface until the field is below 1 for certain, by more than neighbouring blocks can differ.
  constexpr float enough = 2e-5F;
  double step = 1e-5 * f.nearest * b.half();
  for (int i = 0; i < 12; ++i, step *= 2) {
    out.outside = position + out.normal * step;
    if (state_->kernels.margin(b.view(), to_local(out.outside).data()) > enough) break;
  }
  return out;
}

TraceStatistics BlendTracer::statistics() const {
  TraceStatistics s;
  s.cells = cell_count();
  s.bytes = state_->tree.bytes() + state_->pieces.capacity() * sizeof(Piece) + s.cells * sizeof(void*);
  for (std::size_t i = 0; i < s.cells; ++i)
    if (const Block* b = state_->blocks[i].load()) {
      ++s.blocks;
      s.bytes += b->bytes();
      s.sources += static_cast<std::size_t>((b->view().fine.curve_groups + b->view().fine.point_groups) * lanes);
      s.largest_error = std::max(s.largest_error, b->f_error() + b->gradient_error() / state_->field.degree);
    }
  return s;
}

}  // namespace marrow
