#include "field/trace/blend_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "field/trace/angle_field.h"
#include "field/trace/block.h"
#include "field/trace/cell_tree.h"
#include "field/trace/precision.h"
#include "field/trace/serial.h"
#include "field/trace/strands.h"

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

// IsoCurve::margin() for all shares that alpha may have on a step along the normal, as in march.h.
double margin_of_shares(const PointField& f, const Vec3d& normal, double step, const BlockLevel& fine,
                        const IsoCurve& iso, double x, double y, double n) {
  const double left = 1 - (4 * n + 2) * step / f.nearest;
  if (!(left > 0.1) || !(f.share_bend < std::numeric_limits<float>::infinity()))
    return std::min(iso.margin(x, y, 0), iso.margin(x, y, 1));
  const double move = dot(vec(f.share_gradient), normal) * step, bend = f.share_bend * step * step;
  // What strands give is within 1e-4 at 99 of 100 random places (an estimate); else floats are rounded.
  const double known_to = fine.level.strands != nullptr ? 2e-4 : 1e-5;
  const double error = 2 * (fine.angle_error + f.share * fine.f_error) / std::max(1e-20F, f.f) + known_to;
  return std::min(iso.margin(x, y, f.share + (std::min(0.0, move - bend) - error) / left),
                  iso.margin(x, y, f.share + (std::max(0.0, move + bend) + error) / left));
}

// How far to go along the normal until the field is certainly below 1: f and |G| there are bounded by their Taylor
// polynomials and the remainders B3 and B4 of tracing.md, with series sums up to twice their values at 0 (a step of at
// most a tenth of the distance). Twice the errors of the block, since a ray may start in its neighbour. Where no step
// is proved, beside a touch of the surface with itself, the one that comes nearest to it. Block coordinates.
double step_outside(const PointField& f, const Vec3d& normal, const Vec3d& bent, const BlockLevel& fine,
                    const IsoCurve& iso, int degree) {
  const double slope = dot(vec(f.gradient), normal), n = degree;
  // As march.h: sums of floats, and positions in float.
  const double raise = 1 + 2 * (4e-6 + 2e-7 * (n + 1) / f.nearest);
  constexpr double enough = 2e-5;  // so that rays get away from where rounding leaves doubts
  double best = 0, largest = -std::numeric_limits<double>::infinity();
  for (double step = 2e-6 * f.nearest; step < 0.1 * f.nearest; step *= 2) {
    const double bend = f.second * n * (n + 1) * step * step;
    const double x = f.f + slope * step + bend + 2 * fine.f_error, x_low = f.f + slope * step - bend - 2 * fine.f_error;
    const double y =
        length(vec(f.si_gradient) + bent * step) + f.third * (n + 1) * (n + 2) * step * step + 2 * fine.gradient_error;
    double margin = iso.margin(x * raise, y * raise);
    if (iso.views().size() > 1) margin = margin_of_shares(f, normal, step, fine, iso, x * raise, y * raise, n);
    if (iso.two_sided()) margin = std::min(margin, iso.margin(std::max(0.0, x_low / raise), y * raise));
    if (margin > enough) return step;
    if (margin > largest) {
      largest = margin;
      best = step;
    }
  }
  return best;
}

CellTreeSettings cells_of(const TraceOptions& options, std::size_t piece_count) {
  CellTreeSettings settings = options.cells.value_or(cells_for(piece_count));
  if (options.spacing) settings.spacing = options.spacing;
  return settings;
}

// With the angle at which most is inside, where it varies.
Correction correction_for(const BlendField& field) {
  const auto range = angle_range(field);
  const double alpha = range ? range->least : single_angle(field).value_or(field.alpha);
  return Correction(field.degree, alpha, field.cavity, field.projection);
}

}  // namespace

struct BlendTracer::State {
  BlendField field;
  Correction correction;
  std::optional<AngleRange> range;  // of an alpha that varies
  IsoCurve iso;
  PieceCutter cutter;
  SourceTree sources, angle_sources;  // the second one where skeletons have an angle each
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
        iso(range ? IsoCurve(correction, range->least, range->most) : IsoCurve(correction, correction.alpha())),
        cutter(field.degree, iso.critical_field()),
        sources(cutter.cut(field), field.degree),
        angle_sources(
            range && field.alpha_per_skeleton ? angle_pieces(field, *range, cutter.cut(field)) : std::vector<Piece>{},
            field.degree),
        kernels(k),
        coarse(field.degree, budget_of(coarse_tolerance, field.degree), kernels),
        fine(field.degree, budget_of(options.tolerance, field.degree), kernels),
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
                options.kept_bytes,
                range && field.alpha_per_skeleton ? &angle_sources : nullptr} {
    if (range && !field.alpha_per_skeleton) {
      strands.emplace(field, sources.pieces(), kernels);
      context.strands = &*strands;
    }
    for (std::size_t i = 0; i < tree.tile_count(); ++i) bounds.include(tree.tile_box(i));
  }

  // |dC/dalpha| <= n - 1 at the surface: |g(f) - G| at alpha = pi/2, with g(1) = n - 1 and G <= 2 g (tracing.md 2);
  // checked numerically for other angles. The share of alpha is a quotient of sums of some 1. What is known of strands
  // is an estimate.
  double largest_error(const BlockLevel& level) const {
    const double range_of_angles = range ? range->most - range->least : 0, steepest = field.degree - 1;
    const double turned = steepest * range_of_angles * (level.angle_error + level.f_error);
    return level.f_error + level.gradient_error / field.degree + turned;
  }
};

Result<std::unique_ptr<BlendTracer>> BlendTracer::make(BlendField field, const TraceOptions& options) {
  if (const std::string part = untraceable_part(field); !part.empty()) return failure(part);
  const BlockKernels* kernels = block_kernels(options.instruction_set);
  if (kernels == nullptr)
    return failure("instruction set \"" + options.instruction_set + "\" is unknown or not of this machine");
  // Without an f from which on all is inside, no distance to a skeleton is certainly inside.
  if (!(critical_field_of(correction_for(field)) < 100))
    return failure(
        "`cavity: false` with so small an `alpha` lets holes open anywhere inside; it can be evaluated (probe, slice) "
        "but not rendered");
  return std::unique_ptr<BlendTracer>(new BlendTracer(std::make_unique<State>(std::move(field), options, *kernels)));
}

BlendTracer::BlendTracer(std::unique_ptr<State> state) : state_(std::move(state)) {}
BlendTracer::~BlendTracer() = default;

std::size_t BlendTracer::tile_count() const { return state_->tree.tile_count(); }
Box3 BlendTracer::tile_box(std::size_t tile) const { return state_->tree.tile_box(tile); }
const BlendField& BlendTracer::field() const { return state_->field; }

const Block& BlendTracer::block(const Tile& tile, int slot) const {
  return tile.block(slot).get(
      [&] { return std::make_unique<const Block>(state_->context, CellTree::cell(tile, slot)); });
}

namespace {

// A ray in the coordinates of a cube, with t counted from its point nearest to the centre of the cube.
struct RayInCube {
  double t_near, half;
  LocalRay local;

  RayInCube(const Ray& ray, const Vec3d& center, double cube_half)
      : t_near(dot(center - ray.origin, ray.direction)), half(cube_half) {
    const double scale = 1 / half;
    const Vec3d start = (ray.origin - center + ray.direction * t_near) * scale;
    for (std::size_t i = 0; i < 3; ++i) {
      local.origin[i] = static_cast<float>(start[i]);
      local.direction[i] = static_cast<float>(ray.direction.vec()[i]);
    }
  }
  float to_local(double t) const { return static_cast<float>((t - t_near) / half); }
  double to_world(float t) const { return t_near + static_cast<double>(t) * half; }
};

}  // namespace

std::optional<CellHit> BlendTracer::first_hit(std::size_t tile, const Ray& ray, bool any, CellLog& log) const {
  const Vec3d& direction = ray.direction;
  const Tile& made = state_->tree.tile(tile);
  auto [enter, exit] = clip(made.content_box(), ray, {1 / direction.x, 1 / direction.y, 1 / direction.z});
  log.enter = enter;
  log.side = CellLog::Side::Unknown;
  if (any) exit = std::min(exit, ray.t_max);
  if (!(enter < exit)) return {};
  const auto hit = hit_in(made, ray, any, enter, exit, log);
  return hit && hit->t <= ray.t_max ? hit : std::nullopt;
}

// The slots of an octant that is one cell follow each other along the ray: they count as one.
std::optional<CellHit> BlendTracer::hit_in(const Tile& tile, const Ray& ray, bool any, double enter, double exit,
                                           CellLog& log) const {
  const TileContent& content = tile.content();
  const RayInCube cube(ray, tile.place().center, tile.place().half);
  Walk walk;
  const float first = cube.to_local(enter);
  state_->kernels.walk(tile.occupied(), cube.local, first, cube.to_local(exit), walk);
  const auto holder = [&](int i) {
    const int octant = path_of(walk.slot[i]).outer;
    return content.large_cells >> octant & 1 ? slot_at({octant, 0}) : walk.slot[i];
  };
  for (int i = 0; i < walk.count; ++i) {
    const int slot = holder(i);
    // Exactly where the ray comes in, not that place as a float: a ray that begins here must be known to.
    const double from = walk.begin[i] <= first ? enter : std::max(enter, cube.to_world(walk.begin[i]));
    while (i + 1 < walk.count && holder(i + 1) == slot) ++i;
    const double to = std::min(exit, cube.to_world(walk.end[i]));
    const auto hit = content.cells >> slot & 1 ? hit_in(tile, slot, ray, any, from, to, log)
                                               : hit_in(state_->tree.child(tile, slot), ray, any, from, to, log);
    if (hit) return hit;
  }
  return {};
}

namespace {

// Whether a ray begins inside, by the exact field: asked only when a block is entered inside. Rays of a camera share
// their beginning. `bounds` hold all tiles, and so all that is inside.
bool begins_inside(const BlendField& field, const Box3& bounds, std::uint64_t tracer, const Ray& ray) {
  struct Place {
    std::uint64_t tracer = 0;
    Vec3d at;
    bool inside = false;
  };
  thread_local Place last;
  const Vec3d at = ray.at(ray.t_min);
  if (!bounds.contains(at)) return false;
  if (last.tracer != tracer || !(last.at == at)) last = {tracer, at, corrected_value(field, at) >= 1};
  return last.inside;
}

}  // namespace

std::optional<CellHit> BlendTracer::hit_in(const Tile& tile, int slot, const Ray& ray, bool any, double enter,
                                           double exit, CellLog& log) const {
  const Block& b = block(tile, slot);
  if (b.empty()) {
    tile.note_empty(slot);
    return {};
  }
  const RayInCube cube(ray, b.center(), b.half());
  BlockKernels::Query query{.t0 = cube.to_local(enter),
                            .t1 = cube.to_local(exit),
                            .any = any,
                            .from_surface = enter <= ray.t_min,
                            .from_outside = log.side == CellLog::Side::Outside,
                            .leaving = log.side == CellLog::Side::Inside};
  Root root = state_->kernels.first_root(b.view(), cube.local, query);
  log.evaluations += static_cast<std::uint32_t>(root.evaluations);
  if (root.begins_outside) log.side = CellLog::Side::Outside;
  if (root.enters_inside && begins_inside(state_->field, state_->bounds, state_->serial, ray)) {
    log.side = CellLog::Side::Inside;
    query.leaving = true;
    root = state_->kernels.first_root(b.view(), cube.local, query);
    log.evaluations += static_cast<std::uint32_t>(root.evaluations);
  }
  log.undecided = std::min(log.undecided, cube.to_world(root.undecided));
  if (!root.hit) return {};
  return CellHit{std::max(cube.to_world(root.t), ray.t_min), &b};
}

SurfacePoint BlendTracer::surface_at(std::size_t tile, const Vec3d& position) const {
  const CellTree::Cell cell = state_->tree.nearest_cell(tile, position);
  return surface_at(block(*cell.tile, cell.slot), position);
}

SurfacePoint BlendTracer::surface_at(const Block& b, const Vec3d& position) const {
  const Vec3d x = (position - b.center()) / b.half();
  const float local[3] = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
  const PointField f = state_->kernels.point_field(b.fine().level, state_->field.degree, local);
  const Vec3d gradient = vec(f.gradient), g = vec(f.si_gradient);
  const float* h = f.hessian;
  const auto bend = [&](const Vec3d& v) {  // H v
    return Vec3d{h[0] * v.x + h[3] * v.y + h[4] * v.z, h[3] * v.x + h[1] * v.y + h[5] * v.z,
                 h[4] * v.x + h[5] * v.y + h[2] * v.z};
  };
  const double y = length(g);
  const IsoCurve::Gradient c = state_->iso.gradient(f.f, y, f.share);
  Vec3d growth = gradient * c.x + bend(g) * (c.y / std::max(y, 1e-12));
  if (state_->range) growth += vec(f.share_gradient) * c.share;
  SurfacePoint out;
  out.normal = normalize(-growth);
  out.outside = position + out.normal * (b.half() * step_outside(f, out.normal, bend(out.normal), b.fine(), state_->iso,
                                                                 state_->field.degree));
  return out;
}

TraceStatistics BlendTracer::statistics() const {
  TraceStatistics s;
  const CellTree::Size size = state_->tree.size();
  s.tiles = tile_count();
  s.cells = size.cells;
  s.bytes = size.bytes + state_->sources.bytes() + state_->arena.bytes();
  state_->tree.for_each_tile(false, [&](const Tile& tile) {
    for (std::uint64_t left = tile.content().cells; left != 0; left &= left - 1) {
      const Block* b = tile.block(std::countr_zero(left)).peek();
      if (b == nullptr) continue;
      ++s.blocks;
      s.bytes += sizeof(Block);
      const BlockLevel* fine = b->fine_if_kept();
      if (fine == nullptr) continue;
      s.sources += static_cast<std::size_t>((fine->level.curve_groups + fine->level.point_groups) * lanes);
      s.largest_error = std::max(s.largest_error, state_->largest_error(*fine));
    }
  });
  return s;
}

}  // namespace marrow
