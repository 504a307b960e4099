#include "field/trace/block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "field/trace/level_cache.h"
#include "field/trace/serial.h"
#include "field/trace/source_groups.h"
#include "field/trace/strand_axes.h"
#include "field/trace/strands.h"

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
  std::size_t floats() const { return source_floats() + 4 * monomials_to_degree(far_degree); }
};

Level make_level(const Block::Context& context, const NearFar& precision, std::span<const Piece> pieces,
                 const Surroundings& around, const CellTree::Cell& cell, int far_degree) {
  SourceEmitter emitter(context, precision, cell.center, cell.half);
  for (const SourceRef ref : around.near) emitter.emit(pieces[ref.index()]);
  Level level{std::move(emitter.curves), std::move(emitter.points), around.far, far_degree};
  level.far.f_error += emitter.f_error;
  level.far.gradient_error += emitter.gradient_error;
  truncate(level.far, far_degree);
  return level;
}

// The field of angles, at the same errors, from its own tree; nothing where alpha is constant.
std::optional<Level> make_angle_level(const Block::Context& context, const NearFar& precision,
                                      const CellTree::Cell& cell, int far_degree) {
  if (context.angle == nullptr) return {};
  constexpr double open_all = -1;
  Surroundings s;
  s.near = precision.split(*context.angle, context.angle->roots(), cell.center, cell.half, open_all, s.far);
  return make_level(context, precision, context.angle->pieces(), s, cell, far_degree);
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

FieldLevel write_field(const Level& level, float* sources) {
  const auto curve_floats = static_cast<std::size_t>(level.curves.group_count() * floats_per_group);
  float* const far = sources + level.source_floats();
  std::copy_n(level.curves.data(), curve_floats, sources);
  std::copy_n(level.points.data(), level.source_floats() - curve_floats, sources + curve_floats);
  const std::size_t monomials = monomials_to_degree(level.far_degree);
  write_far(level.far, monomials, far);
  const FarRange range(far, monomials);
  return {.sources = sources,
          .curve_groups = level.curves.group_count(),
          .point_groups = level.points.group_count(),
          .far_degree = level.far_degree,
          .far = far,
          .far_slope = range.slope[0],
          .far_g_slope = FarRange::length(range.slope),
          .far_bend = range.bend[0],
          .far_g_bend = FarRange::length(range.bend)};
}

// The near pieces strand by strand, each with groups of its own; then what has been counted among the far strands.
struct StrandedLevel {
  Level level;
  CellStrands seen;
  std::vector<int> groups;        // of each strand of `seen`
  std::vector<float> directions;  // as StrandLevel::directions
  int lanes_told = 0;             // of the curves
};

StrandedLevel make_stranded_level(const Block::Context& context, const CellTree::Cell& cell) {
  const Surroundings around = context.tree.surroundings(cell);
  const Strands& strands = *context.strands;
  std::vector<std::uint32_t> near;
  for (const SourceRef ref : around.near) near.push_back(ref.index());
  std::sort(near.begin(), near.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(strands.strand_of(a), a) < std::pair(strands.strand_of(b), b);
  });
  StrandedLevel out{.level = {.curves = {}, .points = {}, .far = around.far, .far_degree = field_degree},
                    .seen = strands.around(*cell.tile, cell.center, cell.half, near),
                    .groups = {},
                    .directions = {}};
  SourceEmitter emitter(context, context.fine, cell.center, cell.half);
  const auto emit = [&](std::uint32_t piece) {
    emitter.emit(context.pieces[piece]);
    const Vec3d u = strands.direction(piece);
    out.directions.resize(static_cast<std::size_t>(emitter.curves.group_count()) * 3 * lanes);
    for (int lane = out.lanes_told; lane < emitter.curves.count(); ++lane)
      for (std::size_t k = 0; k < 3; ++k)
        out.directions[static_cast<std::size_t>(lane / lanes * 3 * lanes + lane % lanes) + k * lanes] =
            static_cast<float>(u[k]);
    out.lanes_told = emitter.curves.count();
  };
  std::size_t at = 0;
  std::vector<std::uint32_t> counted;
  for (const std::uint32_t strand : out.seen.view.near) {
    for (; at < near.size() && strands.strand_of(near[at]) < strand; ++at) counted.push_back(near[at]);
    const int before = emitter.curves.group_count();
    for (; at < near.size() && strands.strand_of(near[at]) == strand; ++at) emit(near[at]);
    emitter.curves.end_group();
    out.lanes_told = emitter.curves.count();
    out.groups.push_back(emitter.curves.group_count() - before);
  }
  counted.insert(counted.end(), near.begin() + static_cast<std::ptrdiff_t>(at), near.end());
  for (const std::uint32_t piece : counted) emit(piece);
  out.level.curves = std::move(emitter.curves);
  out.level.points = std::move(emitter.points);
  out.level.far.f_error += emitter.f_error;
  out.level.far.gradient_error += emitter.gradient_error;
  return out;
}

// Whether the errors count wherever "outside" is to be proved, or are only stated.
enum class Errors { Counted, Stated };

// In one piece of memory: the level, then the field of angles, then what refers to it.
template <class Memory>
BlockLevel write_level(const Level& level, const std::optional<Level>& angle, Errors errors, Memory& memory) {
  const auto floats_of = [](const Level& l) { return (l.floats() + lanes - 1) / lanes * lanes; };
  constexpr std::size_t reference_floats = (sizeof(FieldLevel) + sizeof(float) - 1) / sizeof(float);
  const std::size_t own = floats_of(level), second = angle ? floats_of(*angle) : 0;
  float* const at = memory.allocate(own + second + (angle ? reference_floats : 0));
  const double counted = errors == Errors::Counted ? 1.0001 : 0;
  BlockLevel out{
      .level = write_field(level, at), .f_error = level.far.f_error, .gradient_error = level.far.gradient_error};
  out.level.f_error = static_cast<float>(counted * out.f_error);
  out.level.g_error = static_cast<float>(counted * out.gradient_error);
  if (angle) {
    auto* const reference = new (at + own + second) FieldLevel(write_field(*angle, at + own));
    out.angle_error = angle->far.f_error;
    reference->f_error = static_cast<float>(counted * out.angle_error);
    out.level.angle = reference;
  }
  return out;
}

// The level, then its directions, the far strands, the rests of near ones, the counts of their groups, and what refers
// to them.
template <class Memory>
BlockLevel write_stranded_level(const StrandedLevel& from, double half, Memory& memory) {
  const auto floats_of = [](std::size_t n) { return (n + lanes - 1) / lanes * lanes; };
  constexpr std::size_t reference_floats = (sizeof(StrandLevel) + sizeof(float) - 1) / sizeof(float);
  const CellStrands& seen = from.seen;
  const std::size_t own = floats_of(from.level.floats()), count = from.groups.size();
  const std::size_t stride = floats_of(count), row = 4 * stride;
  float* const at = memory.allocate(own + from.directions.size() + seen.far.size() + quadratic_monomials * row +
                                    stride + reference_floats);
  float* const directions = at + own;
  float* const far = std::copy(from.directions.begin(), from.directions.end(), directions);
  float* const rest = std::copy(seen.far.begin(), seen.far.end(), far);
  std::fill_n(rest, quadratic_monomials * row, 0.0F);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t m = 0; m < quadratic_monomials; ++m)
      for (std::size_t k = 0; k < 4; ++k) rest[m * row + k * stride + i] = seen.rest[i].sums[4 * m + k];
  auto* const groups = reinterpret_cast<int*>(rest + quadratic_monomials * row);
  std::uninitialized_copy(from.groups.begin(), from.groups.end(), groups);
  auto* const reference = new (rest + quadratic_monomials * row + stride)
      StrandLevel{.directions = directions,
                  .groups = groups,
                  .rest = rest,
                  .count = static_cast<int>(count),
                  .far = far,
                  .axes = strand_axes(),
                  .far_inverse2 = static_cast<float>(seen.view.far_inverse2 * half * half)};
  for (int i = 0; i < 3; ++i) reference->far_bend[i] = static_cast<float>(seen.view.far_bend[i] * half * half);
  BlockLevel out{.level = write_field(from.level, at),
                 .f_error = from.level.far.f_error,
                 .gradient_error = from.level.far.gradient_error,
                 .angle_error = seen.view.error};
  out.level.strands = reference;
  return out;
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
            .iso = context.iso.view(),
            .rows = context.iso.views().data(),
            .row_count = static_cast<int>(context.iso.views().size())} {
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
    return write_level(make_level(context_, context_.coarse, context_.pieces, context_.tree.coarse_surroundings(cell_),
                                  cell_, coarse_far_degree),
                       make_angle_level(context_, context_.coarse, cell_, coarse_far_degree), Errors::Counted, memory);
  });
}

const BlockLevel& Block::fine() const {
  thread_local LevelCache cache;
  return level(fine_, cache, [&](auto& memory) {
    if (context_.strands != nullptr)
      return write_stranded_level(make_stranded_level(context_, cell_), cell_.half, memory);
    return write_level(
        make_level(context_, context_.fine, context_.pieces, context_.tree.surroundings(cell_), cell_, field_degree),
        make_angle_level(context_, context_.fine, cell_, field_degree), Errors::Stated, memory);
  });
}

}  // namespace marrow
