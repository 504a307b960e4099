#include "field/trace/block.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#include "field/math/elementary.h"

namespace marrow {
namespace {

struct Source {
  Vec3d at;
  double weight, radius;
};

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

  std::vector<Source> curves, points;
  double f_error = 0, gradient_error = 0;

  // Cut in halves until a rule is certified at the distance from which the field matters: nearer than
  // inside_distance the surface cannot be. The depth ends where a part is a thousandth of its piece.
  void emit(const Piece& whole) {
    if (whole.is_point()) {
      const double radius = whole.radius / half_;
      points.push_back({(whole.from - center_) / half_, integer_power(radius, context_.degree - 1), radius});
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
      const auto rule = d > 0 ? precision_.rule_for(part, d, 1) : NearFar::Rule{};
      if (rule.nodes > 0 || r.end - r.begin < 1e-3) {
        add(part, rule);
        continue;
      }
      const double mid = 0.5 * (r.begin + r.end);
      stack[count++] = {mid, r.end};
      stack[count++] = {r.begin, mid};
    }
  }

 private:
  void add(const Piece& part, const NearFar::Rule& found) {
    const GaussNodes rule = gauss_legendre(found.nodes > 0 ? found.nodes : max_gauss_nodes);
    const double unit = part.mass / integer_power(part.radius, context_.degree - 1) / half_;
    for (std::size_t k = 0; k < rule.positions.size(); ++k) {
      const double s = rule.positions[k];
      const double radius = (part.radius_from + (part.radius_to - part.radius_from) * s) / half_;
      curves.push_back({(lerp(part.from, part.to, s) - center_) / half_,
                        rule.weights[k] * unit * integer_power(radius, context_.degree - 1), radius});
    }
    f_error += found.error.field;
    gradient_error += found.error.gradient;
  }

  const Block::Context& context_;
  const NearFar& precision_;
  Vec3d center_;
  double half_;
  Box3 box_;
};

int group_count(std::size_t sources) { return static_cast<int>((sources + lanes - 1) / lanes); }

// Fills whole groups; lanes without a source have weight 0 and stand far away.
void write_groups(std::span<const Source> sources, float* out) {
  for (std::size_t begin = 0; begin < sources.size(); begin += lanes, out += floats_per_group)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const bool used = begin + lane < sources.size();
      const Source s = used ? sources[begin + lane] : Source{{1e5, 1e5, 1e5}, 0, 0};
      out[lane] = static_cast<float>(s.at.x);
      out[lane + 16] = static_cast<float>(s.at.y);
      out[lane + 32] = static_cast<float>(s.at.z);
      out[lane + 48] = static_cast<float>(s.weight);
      out[lane + 64] = static_cast<float>(s.radius);
    }
}

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

}  // namespace

void Block::AlignedDelete::operator()(float* p) const { ::operator delete[](p, std::align_val_t{64}); }

namespace {

// One level of a block before it is laid out.
struct Level {
  std::vector<Source> curves, points;
  FarField far;

  int curve_groups() const { return group_count(curves.size()); }
  int point_groups() const { return group_count(points.size()); }
  std::size_t source_floats() const {
    return static_cast<std::size_t>((curve_groups() + point_groups()) * floats_per_group);
  }
};

Level make_level(const Block::Context& context, const NearFar& precision, std::span<const PieceIndex> near,
                 const FarField& far, const Vec3d& center, double half) {
  SourceEmitter emitter(context, precision, center, half);
  Level level;
  level.far = far;
  for (const PieceIndex i : precision.split(context.pieces, near, center, half, level.far))
    emitter.emit(context.pieces[i]);
  level.far.f_error += emitter.f_error;
  level.far.gradient_error += emitter.gradient_error;
  level.curves = std::move(emitter.curves);
  level.points = std::move(emitter.points);
  return level;
}

FieldLevel write_level(const Level& level, float* sources, float* far) {
  write_groups(level.curves, sources);
  write_groups(level.points, sources + level.curve_groups() * floats_per_group);
  write_far(level.far, far);
  return {.sources = sources,
          .curve_groups = level.curve_groups(),
          .point_groups = level.point_groups(),
          .far = far};
}

}  // namespace

Block::Block(const Context& context, const CellTree::Cell& cell)
    : center_(context.tree.center(cell)), half_(context.tree.half(cell)) {
  const CellTree::Branch& branch = context.tree.branch(cell);
  const FarField inherited = branch.far.of_child(cell.octant);
  const Level coarse = make_level(context, context.coarse, branch.near, inherited, center_, half_);
  const Level fine = make_level(context, context.fine, branch.near, inherited, center_, half_);
  f_error_ = fine.far.f_error;
  gradient_error_ = fine.far.gradient_error;

  const std::size_t coarse_floats = coarse.source_floats(), fine_floats = fine.source_floats();
  float_count_ = coarse_floats + fine_floats + 2 * far_floats;
  floats_.reset(static_cast<float*>(::operator new[](float_count_ * sizeof(float), std::align_val_t{64})));
  float* const far = floats_.get() + coarse_floats + fine_floats;
  view_ = {.coarse = write_level(coarse, floats_.get(), far),
           .fine = write_level(fine, floats_.get() + coarse_floats, far + far_floats),
           .degree = context.degree,
           .iso = context.iso.view()};
  // The coarse level is compared with the fine one, so both errors count.
  view_.coarse.f_error = static_cast<float>(1.0001 * (coarse.far.f_error + f_error_));
  view_.coarse.g_error = static_cast<float>(1.0001 * (coarse.far.gradient_error + gradient_error_));
  mask_ = context.kernels.mask(view_);
}

std::size_t Block::bytes() const { return sizeof(Block) + float_count_ * sizeof(float); }

}  // namespace marrow
