#include "field/trace/blend_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "field/trace/block.h"
#include "field/trace/cell_tree.h"
#include "field/trace/precision.h"

namespace marrow {
namespace {

// [t_enter, t_exit] of the ray in a box; the same plane gives the same t in neighbouring cells.
std::pair<double, double> clip(const Box3& box, const Ray& ray, const Vec3d& inverse_direction) {
  double enter = ray.t_min, exit = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double o = ray.origin[i], k = inverse_direction[i];
    if (std::isinf(k)) {
      if (o < box.lower[i] || o > box.upper[i]) return {1, 0};
      continue;
    }
    const double a = (box.lower[i] - o) * k, b = (box.upper[i] - o) * k;
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return {enter, exit};
}

Vec3d vec(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// How far to go along the normal until the field is certainly below 1, by more than rounding and neighbouring blocks
// can differ: f and |G| there are bounded by their Taylor polynomials and the remainders B3 and B4 of tracing.md, with
// series sums up to twice their values at 0 (a step of at most a tenth of the distance). Block coordinates.
double step_outside(const PointField& f, const Vec3d& normal, const Vec3d& bent, const IsoCurve& iso, int degree) {
  constexpr double enough = 2e-5;
  const double slope = dot(vec(f.gradient), normal), n = degree;
  double step = 1e-5 * f.nearest;
  for (; step < 0.1 * f.nearest; step *= 2) {
    const double x = f.f + slope * step + f.second * n * (n + 1) * step * step;
    const double y = length(vec(f.si_gradient) + bent * step) + f.third * (n + 1) * (n + 2) * step * step;
    const double x_low = f.f + slope * step - f.second * n * (n + 1) * step * step;
    if (iso.margin(x, y) > enough && (!iso.two_sided() || iso.margin(x_low, y) > enough)) return step;
  }
  return 1e-4 * f.nearest;  // not proved: beside a touch of the surface with itself
}

}  // namespace

struct BlendTracer::State {
  BlendField field;
  Correction correction;
  IsoCurve iso;
  PieceCutter cutter;
  std::vector<Piece> pieces;
  const BlockKernels& kernels;
  NearFar coarse, fine;
  LatticeErrors lattice;
  CellTree tree;
  mutable BlockArena arena;
  mutable std::unique_ptr<std::atomic<const Block*>[]> blocks;

  State(BlendField f, const TraceOptions& options, const BlockKernels& k)
      : field(std::move(f)),
        correction(correction_of(field)),
        iso(correction, field.alpha),
        cutter(field.degree, iso.critical_field()),
        pieces(cutter.cut(field)),
        kernels(k),
        coarse(field.degree, budget_of(coarse_tolerance, field.degree), kernels),
        fine(field.degree, budget_of(options.tolerance, field.degree), kernels),
        lattice(field.degree),
        tree(pieces, fine, iso, kernels, field.degree, cells_for(pieces.size())),
        blocks(new std::atomic<const Block*>[tree.cells().size()] {}) {}
  ~State() {
    for (std::size_t i = 0; i < tree.cells().size(); ++i) delete blocks[i].load();
  }
  Block::Context context() const { return {pieces, tree, cutter, coarse, fine, lattice, iso, kernels, field.degree}; }
};

Result<std::unique_ptr<BlendTracer>> BlendTracer::make(BlendField field, const TraceOptions& options) {
  if (const std::string part = untraceable_part(field); !part.empty()) return failure(part);
  const BlockKernels* kernels = block_kernels(options.instruction_set);
  if (kernels == nullptr)
    return failure("instruction set \"" + options.instruction_set + "\" is unknown or not of this machine");
  // Without an f from which on all is inside, no distance to a skeleton is certainly inside.
  if (!(critical_field_of(correction_of(field)) < 100))
    return failure(
        "`cavity: false` with so small an `alpha` lets holes open anywhere inside; it can be evaluated (probe, slice) "
        "but not rendered");
  return std::unique_ptr<BlendTracer>(new BlendTracer(std::make_unique<State>(std::move(field), options, *kernels)));
}

BlendTracer::BlendTracer(std::unique_ptr<State> state) : state_(std::move(state)) {}
BlendTracer::~BlendTracer() = default;

std::size_t BlendTracer::cell_count() const { return state_->tree.cells().size(); }
Box3 BlendTracer::cell_box(std::size_t cell) const { return state_->tree.cells()[cell].box(); }
const BlendField& BlendTracer::field() const { return state_->field; }

// Two threads may build the same block; both get the same content, and one copy is kept.
const Block& BlendTracer::block(std::size_t cell) const {
  std::atomic<const Block*>& slot = state_->blocks[cell];
  if (const Block* ready = slot.load(std::memory_order_acquire)) return *ready;
  auto made = std::make_unique<const Block>(state_->context(), state_->tree.cells()[cell], state_->arena);
  const Block* expected = nullptr;
  if (slot.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *made.release();
  return *expected;
}

std::optional<CellHit> BlendTracer::first_hit(std::size_t cell, const Ray& ray, bool any, CellLog& log) const {
  const Vec3d& direction = ray.direction;
  const Vec3d inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
  auto [enter, exit] = clip(cell_box(cell), ray, inverse);
  log.enter = enter;
  if (any) exit = std::min(exit, ray.t_max);
  if (!(enter < exit)) return {};
  const Block& b = block(cell);
  // Block coordinates, with t counted from the point of the ray nearest to the block's centre.
  const double t_near = dot(b.center() - ray.origin, ray.direction), scale = 1 / b.half();
  const Vec3d start = (ray.origin - b.center() + direction * t_near) * scale;
  LocalRay local;
  for (std::size_t i = 0; i < 3; ++i) {
    local.origin[i] = static_cast<float>(start[i]);
    local.direction[i] = static_cast<float>(direction[i]);
  }
  const auto world_t = [&](float t) { return t_near + static_cast<double>(t) * b.half(); };
  const Root root = state_->kernels.first_root(b.view(), local,
                                               {.t0 = static_cast<float>((enter - t_near) * scale),
                                                .t1 = static_cast<float>((exit - t_near) * scale),
                                                .any = any,
                                                .from_surface = enter <= ray.t_min});
  log.evaluations += static_cast<std::uint32_t>(root.evaluations);
  log.undecided = std::min(log.undecided, world_t(root.undecided));
  if (!root.hit) return {};
  const double t = std::clamp(world_t(root.t), enter, exit);
  return t <= ray.t_max ? std::optional(CellHit{t}) : std::nullopt;
}

SurfacePoint BlendTracer::surface_at(std::size_t cell, const Vec3d& position) const {
  const Block& b = block(cell);
  const Vec3d x = (position - b.center()) / b.half();
  const float local[3] = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
  const PointField f = state_->kernels.point_field(b.view(), local);
  const Vec3d gradient = vec(f.gradient), g = vec(f.si_gradient);
  const float* h = f.hessian;
  const auto bend = [&](const Vec3d& v) {  // H v
    return Vec3d{h[0] * v.x + h[3] * v.y + h[4] * v.z, h[3] * v.x + h[1] * v.y + h[5] * v.z,
                 h[4] * v.x + h[5] * v.y + h[2] * v.z};
  };
  const double y = length(g);
  const IsoCurve::Slope c = state_->iso.gradient(f.f, y);
  SurfacePoint out;
  out.normal = normalize(-(gradient * c.x + bend(g) * (c.y / std::max(y, 1e-12))));
  out.outside = position + out.normal * (b.half() * step_outside(f, out.normal, bend(out.normal), state_->iso,
                                                                 state_->field.degree));
  return out;
}

TraceStatistics BlendTracer::statistics() const {
  TraceStatistics s;
  s.cells = cell_count();
  s.bytes = state_->tree.bytes() + state_->pieces.capacity() * sizeof(Piece) + s.cells * sizeof(void*) +
            state_->arena.bytes();
  for (std::size_t i = 0; i < s.cells; ++i)
    if (const Block* b = state_->blocks[i].load()) {
      ++s.blocks;
      s.bytes += sizeof(Block);
      s.sources += static_cast<std::size_t>((b->view().fine.curve_groups + b->view().fine.point_groups) * lanes);
      s.largest_error = std::max(s.largest_error, b->f_error() + b->gradient_error() / state_->field.degree);
    }
  return s;
}

}  // namespace marrow
