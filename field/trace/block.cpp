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

Level make_level(const Block::Context& context, const NearFar& precision, std::span<const PieceIndex> near,
                 const FarField& far, const Vec3d& center, double half) {
  SourceEmitter emitter(context, precision, center, half);
  for (const PieceIndex i : near) emitter.emit(context.pieces[i]);
  Level level{std::move(emitter.curves), std::move(emitter.points), far};
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

Block::Block(const Context& context, const CellTree::Cell& cell, BlockArena& arena)
    : center_(cell.center), half_(cell.half) {
  auto [sources, far_field] = context.tree.surroundings(cell);
  std::vector<PieceIndex> near;
  for (const SourceRef ref : sources) near.push_back(ref.index());
  const Level fine = make_level(context, context.fine, near, far_field, center_, half_);
  // What is far to the fine level is far to the coarse one too.
  const auto nearest = context.coarse.split(context.pieces, near, center_, half_, far_field);
  const Level coarse = make_level(context, context.coarse, nearest, far_field, center_, half_);
  f_error_ = fine.far.f_error;
  gradient_error_ = fine.far.gradient_error;

  // The polynomials are compared with the fine level, so both errors count.
  std::vector<SourceGroup> memory((coarse.source_floats() + far_floats) / floats_per_group + 1);
  float* const scratch = memory.front().x;
  FieldLevel level = write_level(coarse, scratch, scratch + coarse.source_floats());
  level.f_error = static_cast<float>(1.0001 * (coarse.far.f_error + f_error_));
  level.g_error = static_cast<float>(1.0001 * (coarse.far.gradient_error + gradient_error_));
  const Patches patches = make_patches(level, context.degree, context.iso, context.lattice, context.kernels);

  constexpr std::size_t node_floats = sizeof(PatchNode) / sizeof(float);
  const std::size_t all_node_floats = patches.nodes.size() * node_floats;
  float* const nodes = arena.allocate(all_node_floats + patches.polynomials.size() + fine.source_floats() + far_floats);
  std::memcpy(nodes, patches.nodes.data(), all_node_floats * sizeof(float));
  float* const fine_sources = nodes + all_node_floats;
  float* const fine_far = fine_sources + fine.source_floats();
  float* const polynomials = fine_far + far_floats;
  std::copy(patches.polynomials.begin(), patches.polynomials.end(), polynomials);
  view_ = {.fine = write_level(fine, fine_sources, fine_far),
           .patches = reinterpret_cast<const PatchNode*>(nodes),
           .polynomials = polynomials,
           .degree = context.degree,
           .iso = context.iso.view()};
}

}  // namespace marrow
