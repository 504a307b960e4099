#include "field/trace/block.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "field/trace/source_groups.h"

namespace marrow {
namespace {

// How far two boxes are apart; a lower bound of the distance of what they hold.
double separation(const Box3& a, const Box3& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double gap = std::max({0.0, a.lower[i] - b.upper[i], b.lower[i] - a.upper[i]});
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

// Turns near pieces into quadrature nodes, in block coordinates.
class SourceEmitter {
 public:
  SourceEmitter(const Block::Context& context, const NearFar& precision, const Vec3d& center, double half)
      : context_(context), precision_(precision), center_(center), half_(half) {
    const Vec3d h{half, half, half};
    box_ = {center - h, center + h};
  }

  SourceGroups curves, points;
  double f_error = 0, gradient_error = 0;

  // Cut in halves until a rule is certified at the distance from which the field matters: nearer than
  // inside_distance the surface cannot be. The depth ends where a part is a thousandth of its piece.
  void emit(const Piece& whole) {
    if (whole.is_point()) {
      add_nodes(whole, 1, center_, half_, context_.degree, points);
      return;
    }
    struct Range {
      double begin, end;
    };
    Range stack[24];
    int count = 0;
    stack[count++] = {0, 1};
    while (count > 0) {
      const Range r = stack[--count];
      const Piece part = r.begin == 0 && r.end == 1 ? whole : context_.cutter.part(whole, r.begin, r.end);
      const double ball = distance(part, center_) - half_ * std::sqrt(3.0);
      const double d = std::max({ball, separation(part.box(), box_), whole.inside_distance});
      const auto rule = precision_.rule_for(part, d, 1);
      if (rule.within || r.end - r.begin < 1e-3) {
        add_nodes(part, rule.nodes, center_, half_, context_.degree, curves);
        f_error += rule.error.field;
        gradient_error += rule.error.gradient;
        continue;
      }
      const double mid = 0.5 * (r.begin + r.end);
      stack[count++] = {mid, r.end};
      stack[count++] = {r.begin, mid};
    }
  }

 private:
  const Block::Context& context_;
  const NearFar& precision_;
  Vec3d center_;
  double half_;
  Box3 box_;
};

// (f, Gx, Gy, Gz) for each monomial, where G = gradient of the potential.
void write_far(const FarField& far, float* out) {
  for (std::size_t i = 0; i < far_monomials; ++i) {
    const Monomial& m = monomials[i];
    out[4 * i] = static_cast<float>(far.f[i]);
    out[4 * i + 1] = static_cast<float>(far.potential[monomial_index(m.a + 1, m.b, m.c)] * (m.a + 1));
    out[4 * i + 2] = static_cast<float>(far.potential[monomial_index(m.a, m.b + 1, m.c)] * (m.b + 1));
    out[4 * i + 3] = static_cast<float>(far.potential[monomial_index(m.a, m.b, m.c + 1)] * (m.c + 1));
  }
}

// One level of a block before it is laid out.
struct Level {
  SourceGroups curves, points;
  FarField far;

  std::size_t source_floats() const {
    return static_cast<std::size_t>((curves.group_count() + points.group_count()) * floats_per_group);
  }
};

Level make_level(const Block::Context& context, const NearFar& precision, const Surroundings& around,
                 const CellTree::Cell& cell) {
  SourceEmitter emitter(context, precision, cell.center, cell.half);
  for (const SourceRef ref : around.near) emitter.emit(context.pieces[ref.index()]);
  Level level{std::move(emitter.curves), std::move(emitter.points), around.far};
  level.far.f_error += emitter.f_error;
  level.far.gradient_error += emitter.gradient_error;
  return level;
}

FieldLevel write_level(const Level& level, float* sources, float* far) {
  const auto curve_floats = static_cast<std::size_t>(level.curves.group_count() * floats_per_group);
  std::copy_n(level.curves.data(), curve_floats, sources);
  std::copy_n(level.points.data(), level.source_floats() - curve_floats, sources + curve_floats);
  write_far(level.far, far);
  return {.sources = sources,
          .curve_groups = level.curves.group_count(),
          .point_groups = level.points.group_count(),
          .far = far};
}

}  // namespace

Block::Block(const Context& context, const CellTree::Cell& cell)
    : context_(context), cell_(cell), source_{coarse_,         context.degree,  context.iso,
                                              context.lattice, context.kernels, context.polynomials} {
  const Level coarse = make_level(context, context.coarse, context.tree.coarse_surroundings(cell), cell);
  float* const sources = context.arena.allocate(coarse.source_floats() + far_floats);
  coarse_ = write_level(coarse, sources, sources + coarse.source_floats());
  coarse_.f_error = static_cast<float>(1.0001 * coarse.far.f_error);
  coarse_.g_error = static_cast<float>(1.0001 * coarse.far.gradient_error);
  view_ = {.octants = nullptr,
           .coarse = coarse_,
           .make_fine = [](const void* owner) -> const FieldLevel& {
             return static_cast<const Block*>(owner)->fine().level;
           },
           .owner = this,
           .degree = context.degree,
           .iso = context.iso.view()};
  octants_.emplace(source_, Cube{.center = {0, 0, 0}, .half = 1}, 1);
  view_.octants = &*octants_;
  for (int i = 0; i < 8; ++i) {
    if (!(octants_->boxes.present >> i & 1)) continue;
    const Vec3d center = octant_center(cell.center, cell.half, i), h{cell.half / 2, cell.half / 2, cell.half / 2};
    box_.include({center - h, center + h});
  }
}

const Block::Fine& Block::fine() const {
  return fine_.get([&] {
    const Level level = make_level(context_, context_.fine, context_.tree.surroundings(cell_), cell_);
    float* const sources = context_.arena.allocate(level.source_floats() + far_floats);
    return std::make_unique<const Fine>(Fine{write_level(level, sources, sources + level.source_floats()),
                                             level.far.f_error, level.far.gradient_error});
  });
}

}  // namespace marrow
