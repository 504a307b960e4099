#include "field/trace/block.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/trace/level_cache.h"
#include "field/trace/serial.h"
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

// (f, Gx, Gy, Gz) for a monomial, where G = gradient of the potential.
std::array<double, 4> far_coefficients(const FarField& far, std::size_t i) {
  const Monomial& m = monomials[i];
  return {far.f[i], far.potential[monomial_index(m.a + 1, m.b, m.c)] * (m.a + 1),
          far.potential[monomial_index(m.a, m.b + 1, m.c)] * (m.b + 1),
          far.potential[monomial_index(m.a, m.b, m.c + 1)] * (m.c + 1)};
}

void write_far(const FarField& far, std::size_t monomial_count, float* out) {
  for (std::size_t i = 0; i < monomial_count; ++i)
    for (const double c : far_coefficients(far, i)) *out++ = static_cast<float>(c);
}

// Leaves only the monomials up to a degree. None of the others is above 1 in the cube.
void truncate(FarField& far, int degree) {
  for (std::size_t i = monomials_to_degree(degree); i < monomials_to_degree(field_degree); ++i) {
    const auto c = far_coefficients(far, i);
    far.f_error += std::fabs(c[0]);
    far.gradient_error += length({c[1], c[2], c[3]});
  }
}

// The errors of the coarse level are far above what its polynomials have beyond this degree.
constexpr int coarse_far_degree = 2;

// One level of a block before it is laid out.
struct Level {
  SourceGroups curves, points;
  FarField far;
  int far_degree;

  std::size_t source_floats() const {
    return static_cast<std::size_t>((curves.group_count() + points.group_count()) * floats_per_group);
  }
};

Level make_level(const Block::Context& context, const NearFar& precision, const Surroundings& around,
                 const CellTree::Cell& cell, int far_degree) {
  SourceEmitter emitter(context, precision, cell.center, cell.half);
  for (const SourceRef ref : around.near) emitter.emit(context.pieces[ref.index()]);
  Level level{std::move(emitter.curves), std::move(emitter.points), around.far, far_degree};
  level.far.f_error += emitter.f_error;
  level.far.gradient_error += emitter.gradient_error;
  truncate(level.far, far_degree);
  return level;
}

// The largest first derivative and half of the largest second one along any line in the cube, of f and of G. A monomial
// in [-1, 1]^3 has a gradient of at most its degree. Its second derivative along a unit vector e is e.A e, |A_ij| at
// most the sum over monomials of their |second derivatives|, and the largest eigenvalue of a symmetric matrix is at
// most its largest sum of a row. |G'| and |G''| by the length of those of the components.
struct FarRange {
  std::array<float, 4> slope{}, bend{};

  FarRange(const float* far, std::size_t monomial_count) {
    for (std::size_t k = 0; k < 4; ++k) add(far, monomial_count, k);
  }
  void add(const float* far, std::size_t monomial_count, std::size_t k) {
    std::array<std::array<float, 3>, 3> second{};
    for (std::size_t i = 1; i < monomial_count; ++i) {
      const Monomial& m = monomials[i];
      const int e[3] = {m.a, m.b, m.c};
      const float c = std::fabs(far[4 * i + k]);
      slope[k] += static_cast<float>(m.degree()) * c;
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
          second[row][column] += static_cast<float>(e[row] * (row == column ? e[row] - 1 : e[column])) * c;
    }
    for (const auto& row : second) bend[k] = std::max(bend[k], 0.5001F * (row[0] + row[1] + row[2]));
  }
  static float length(const std::array<float, 4>& v) { return std::sqrt(v[1] * v[1] + v[2] * v[2] + v[3] * v[3]); }
};

template <class Memory>
BlockLevel write_level(const Level& level, Memory& memory) {
  const auto curve_floats = static_cast<std::size_t>(level.curves.group_count() * floats_per_group);
  const std::size_t monomials = monomials_to_degree(level.far_degree);
  float* const sources = memory.allocate(level.source_floats() + 4 * monomials);
  float* const far = sources + level.source_floats();
  std::copy_n(level.curves.data(), curve_floats, sources);
  std::copy_n(level.points.data(), level.source_floats() - curve_floats, sources + curve_floats);
  write_far(level.far, monomials, far);
  const FarRange range(far, monomials);
  return {.level = {.sources = sources,
                    .curve_groups = level.curves.group_count(),
                    .point_groups = level.points.group_count(),
                    .far_degree = level.far_degree,
                    .far = far,
                    .far_slope = range.slope[0],
                    .far_g_slope = FarRange::length(range.slope),
                    .far_bend = range.bend[0],
                    .far_g_bend = FarRange::length(range.bend)},
          .f_error = level.far.f_error,
          .gradient_error = level.far.gradient_error};
}

bool holds_surface(const CubeBounds& b, const IsoCurve& iso) {
  if (static_cast<double>(b.f_low) > iso.critical_field() * 1.00001) return false;
  return b.touches || !iso.outside(0, static_cast<double>(b.f_high), static_cast<double>(b.g_high));
}

// Whether surface can be in a cube of a block, which is taken a little larger than it is, by far more than the rounding
// of rays in float.
bool may_hold(const Block::Context& context, const FieldLevel& level, const Vec3d& center, double half) {
  constexpr double overlap = 1e-4;
  const float c[3] = {static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z)};
  return holds_surface(context.kernels.cube_bounds(level, context.degree, c, static_cast<float>(half + overlap)),
                       context.iso);
}

// The octants of octants of an octant of a block that bounds do not prove to be outside or inside.
std::uint64_t surface_slots(const Block::Context& context, const FieldLevel& level, int octant) {
  const Vec3d whole = octant_center({0, 0, 0}, 1, octant);
  std::uint64_t slots = 0;
  for (int outer = 0; outer < 8; ++outer) {
    const Vec3d center = octant_center(whole, 0.5, outer);
    if (!may_hold(context, level, center, 0.25)) continue;
    for (int inner = 0; inner < 8; ++inner)
      if (may_hold(context, level, octant_center(center, 0.25, inner), 0.125))
        slots |= std::uint64_t{1} << slot_at({outer, inner});
  }
  return slots;
}

}  // namespace

Block::Block(const Context& context, const CellTree::Cell& cell)
    : context_(context),
      serial_(next_serial()),
      cell_(cell),
      view_{.find_surface = [](const void* owner,
                               int octant) { return static_cast<const Block*>(owner)->surface(octant); },
            .make_coarse = [](const void* owner) -> const FieldLevel& {
              return static_cast<const Block*>(owner)->coarse().level;
            },
            .make_fine = [](const void* owner) -> const FieldLevel& {
              return static_cast<const Block*>(owner)->fine().level;
            },
            .owner = this,
            .degree = context.degree,
            .iso = context.iso.view()} {
  for (int octant = 0; octant < 8; ++octant)
    if (may_hold(context, coarse().level, octant_center({0, 0, 0}, 1, octant), 0.5)) octants_ |= 1U << octant;
}

// Whoever asks first finds the same.
std::uint64_t Block::surface(int octant) const {
  if (!(octants_ >> octant & 1)) return 0;
  auto& slots = surface_[static_cast<std::size_t>(octant)];
  if (!(surface_known_.load(std::memory_order_acquire) >> octant & 1)) {
    slots.store(surface_slots(context_, coarse().level, octant), std::memory_order_relaxed);
    surface_known_.fetch_or(static_cast<std::uint8_t>(1U << octant), std::memory_order_release);
  }
  return slots.load(std::memory_order_relaxed);
}

template <class Make>
const BlockLevel& Block::level(const Lazy<BlockLevel>& kept, LevelCache& cache, const Make& make) const {
  if (const BlockLevel* ready = kept.peek()) return *ready;
  if (BlockArena::bytes_of_all() >= context_.kept_bytes) return cache.get(serial_, make);
  return kept.get([&] { return std::make_unique<const BlockLevel>(make(context_.arena)); });
}

const BlockLevel& Block::coarse() const {
  thread_local LevelCache cache;
  return level(coarse_, cache, [&](auto& memory) {
    const Level level =
        make_level(context_, context_.coarse, context_.tree.coarse_surroundings(cell_), cell_, coarse_far_degree);
    BlockLevel coarse = write_level(level, memory);
    coarse.level.f_error = static_cast<float>(1.0001 * coarse.f_error);
    coarse.level.g_error = static_cast<float>(1.0001 * coarse.gradient_error);
    return coarse;
  });
}

const BlockLevel& Block::fine() const {
  thread_local LevelCache cache;
  return level(fine_, cache, [&](auto& memory) {
    return write_level(make_level(context_, context_.fine, context_.tree.surroundings(cell_), cell_, field_degree),
                       memory);
  });
}

}  // namespace marrow
