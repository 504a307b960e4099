// The sums in eight lanes: each lane adds its own sources in their order, and the lanes are added in theirs, so that
// nothing depends on how wide the machine's vectors are. A register's width of lanes goes after the other, as sums of
// all eight would not stay in sixteen registers of half the width.
#include "field/blend/sources/source_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "field/math/eight_doubles.h"

namespace marrow {
namespace {

using Group = SourceSums::Group;
using Groups = std::span<const Group>;
using Marks = SourceSums::Marks;
static_assert(width<Eight> == SourceSums::lanes);

template <class Part>
struct TotalsOf {
  Part f, S[3], gradient[3], k, J[6], second, third, nearest_inverse;
};
using Totals = TotalsOf<Eight>;

template <class Part>
struct MarkTotalsOf {
  Part first, second, first_gradient[3], second_gradient[3];
};
using MarkTotals = MarkTotalsOf<Eight>;

template <class Part>
[[gnu::always_inline]] inline Part load(const double (&v)[SourceSums::lanes], int lane) {
  return *reinterpret_cast<const Part*>(&v[lane]);
}

// Totals of some lanes, number by number, to their places among all.
template <class Part, class OfPart, class OfAll>
[[gnu::always_inline]] inline void store(const OfPart& t, int lane, OfAll& out) {
  static_assert(sizeof(OfPart) / sizeof(Part) == sizeof(OfAll) / sizeof(Eight));
  const auto* from = reinterpret_cast<const char*>(&t);
  auto* to = reinterpret_cast<char*>(&out) + static_cast<std::size_t>(lane) * sizeof(double);
  for (std::size_t i = 0; i < sizeof(OfPart) / sizeof(Part); ++i)
    std::memcpy(to + i * sizeof(Eight), from + i * sizeof(Part), sizeof(Part));
}

template <class Part>
[[gnu::always_inline]] inline void take_root(Part& x) {
  for (int i = 0; i < width<Part>; ++i) x[i] = std::sqrt(x[i]);
}

// The factors -m and m (m+2) of derivatives are left to the end.
template <class Part, bool WithSlopes>
[[gnu::always_inline]] inline void fold_part(Groups groups, int lane, int m, const Vec3d& p, Totals& out) {
  TotalsOf<Part> t{};
  for (const Group& g : groups) {
    const Part x = p.x - load<Part>(g.x, lane), y = p.y - load<Part>(g.y, lane), z = p.z - load<Part>(g.z, lane),
               tau = load<Part>(g.radius, lane);
    const Part inverse = 1.0 / (x * x + y * y + z * z + load<Part>(g.lift_squared, lane));
    Part root = inverse, f = load<Part>(g.weight, lane);
    if (WithSlopes || m % 2 != 0) take_root(root);
    for (int i = 0; i < m / 2; ++i) f *= inverse;
    if (m % 2 != 0) f *= root;
    const Part steep = f * inverse, k = steep * tau;
    t.f += f;
    t.S[0] += k * x;
    t.S[1] += k * y;
    t.S[2] += k * z;
    if constexpr (WithSlopes) {
      t.gradient[0] += steep * x;
      t.gradient[1] += steep * y;
      t.gradient[2] += steep * z;
      const Part bent = k * inverse, bx = bent * x, by = bent * y;
      t.k += k;
      t.J[0] += bx * x;
      t.J[1] += by * y;
      t.J[2] += bent * z * z;
      t.J[3] += by * z;
      t.J[4] += bx * z;
      t.J[5] += bx * y;
      t.second += steep;
      t.third += k * root;
      t.nearest_inverse = inverse > t.nearest_inverse ? inverse : t.nearest_inverse;
    }
  }
  store<Part>(t, lane, out);
}

// As far away as within rho of p they can be.
template <class Part>
[[gnu::always_inline]] inline void fold_least_part(Groups groups, int lane, int m, const Vec3d& p, double rho,
                                                   Eight& out) {
  Part sum{};
  for (const Group& g : groups) {
    const Part x = p.x - load<Part>(g.x, lane), y = p.y - load<Part>(g.y, lane), z = p.z - load<Part>(g.z, lane);
    Part distance = x * x + y * y + z * z + load<Part>(g.lift_squared, lane), f = load<Part>(g.weight, lane);
    take_root(distance);
    const Part inverse = 1.0 / (distance + rho);
    for (int i = 0; i < m; ++i) f *= inverse;
    sum += f;
  }
  store<Part>(sum, lane, out);
}

// The factor -m of gradients is left to the end.
template <class Part>
[[gnu::always_inline]] inline void fold_marks_part(Groups groups, const Marks* marks, int lane, int m, const Vec3d& p,
                                                   MarkTotals& out) {
  MarkTotalsOf<Part> t{};
  for (const Group& g : groups) {
    const Part x = p.x - load<Part>(g.x, lane), y = p.y - load<Part>(g.y, lane), z = p.z - load<Part>(g.z, lane),
               mark = load<Part>((marks++)->of, lane);
    const Part inverse = 1.0 / (x * x + y * y + z * z + load<Part>(g.lift_squared, lane));
    Part f = load<Part>(g.weight, lane) * mark;
    if (m % 2 != 0) {
      Part root = inverse;
      take_root(root);
      f *= root;
    }
    for (int i = 0; i < m / 2; ++i) f *= inverse;
    const Part squared = f * mark, steep = f * inverse, steep_squared = squared * inverse;
    t.first += f;
    t.second += squared;
    t.first_gradient[0] += steep * x;
    t.first_gradient[1] += steep * y;
    t.first_gradient[2] += steep * z;
    t.second_gradient[0] += steep_squared * x;
    t.second_gradient[1] += steep_squared * y;
    t.second_gradient[2] += steep_squared * z;
  }
  store<Part>(t, lane, out);
}

// The whole, for registers that hold a Part.
template <class Part>
struct FoldsOf {
  template <bool WithSlopes>
  [[gnu::always_inline]] static inline void fold(Groups groups, int m, const Vec3d& p, Totals& out) {
    for (int lane = 0; lane < SourceSums::lanes; lane += width<Part>)
      fold_part<Part, WithSlopes>(groups, lane, m, p, out);
  }
  [[gnu::always_inline]] static inline void least(Groups groups, int m, const Vec3d& p, double rho, Eight& out) {
    for (int lane = 0; lane < SourceSums::lanes; lane += width<Part>)
      fold_least_part<Part>(groups, lane, m, p, rho, out);
  }
  [[gnu::always_inline]] static inline void marks(Groups groups, const Marks* marks, int m, const Vec3d& p,
                                                  MarkTotals& out) {
    for (int lane = 0; lane < SourceSums::lanes; lane += width<Part>)
      fold_marks_part<Part>(groups, marks, lane, m, p, out);
  }
};

[[gnu::target("avx512f,prefer-vector-width=512")]] void values_512(Groups g, int m, const Vec3d& p, Totals& out) {
  FoldsOf<Eight>::fold<false>(g, m, p, out);
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void slopes_512(Groups g, int m, const Vec3d& p, Totals& out) {
  FoldsOf<Eight>::fold<true>(g, m, p, out);
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void least_512(Groups g, int m, const Vec3d& p, double rho,
                                                                  Eight& out) {
  FoldsOf<Eight>::least(g, m, p, rho, out);
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void marks_512(Groups g, const Marks* marks, int m, const Vec3d& p,
                                                                  MarkTotals& out) {
  FoldsOf<Eight>::marks(g, marks, m, p, out);
}
[[gnu::target("avx2")]] void values_256(Groups g, int m, const Vec3d& p, Totals& out) {
  FoldsOf<Four>::fold<false>(g, m, p, out);
}
[[gnu::target("avx2")]] void slopes_256(Groups g, int m, const Vec3d& p, Totals& out) {
  FoldsOf<Four>::fold<true>(g, m, p, out);
}
[[gnu::target("avx2")]] void least_256(Groups g, int m, const Vec3d& p, double rho, Eight& out) {
  FoldsOf<Four>::least(g, m, p, rho, out);
}
[[gnu::target("avx2")]] void marks_256(Groups g, const Marks* marks, int m, const Vec3d& p, MarkTotals& out) {
  FoldsOf<Four>::marks(g, marks, m, p, out);
}
void values_128(Groups g, int m, const Vec3d& p, Totals& out) { FoldsOf<Two>::fold<false>(g, m, p, out); }
void slopes_128(Groups g, int m, const Vec3d& p, Totals& out) { FoldsOf<Two>::fold<true>(g, m, p, out); }
void least_128(Groups g, int m, const Vec3d& p, double rho, Eight& out) { FoldsOf<Two>::least(g, m, p, rho, out); }
void marks_128(Groups g, const Marks* marks, int m, const Vec3d& p, MarkTotals& out) {
  FoldsOf<Two>::marks(g, marks, m, p, out);
}

struct Folds {
  void (*values)(Groups, int, const Vec3d&, Totals&);
  void (*slopes)(Groups, int, const Vec3d&, Totals&);
  void (*least)(Groups, int, const Vec3d&, double, Eight&);
  void (*marks)(Groups, const Marks*, int, const Vec3d&, MarkTotals&);
};

const Folds& folds() {
  static const Folds best = __builtin_cpu_supports("avx512f") ? Folds{values_512, slopes_512, least_512, marks_512}
                            : __builtin_cpu_supports("avx2")  ? Folds{values_256, slopes_256, least_256, marks_256}
                                                              : Folds{values_128, slopes_128, least_128, marks_128};
  return best;
}

double total(const Eight& v) {
  double sum = 0;
  for (int i = 0; i < SourceSums::lanes; ++i) sum += v[i];
  return sum;
}
Vec3d total(const Eight (&v)[3]) { return {total(v[0]), total(v[1]), total(v[2])}; }

}  // namespace

// Lanes without a source repeat the last one with no weight.
void SourceSums::add(const Source& s) {
  const auto lane = static_cast<int>(count_ % lanes);
  if (lane == 0) groups_.emplace_back();
  if (lane == 0 && marked_) marks_.emplace_back();
  Group& g = groups_.back();
  for (int i = lane; i < lanes; ++i) {
    g.x[i] = s.at.x;
    g.y[i] = s.at.y;
    g.z[i] = s.at.z;
    g.weight[i] = i == lane ? s.weight : 0;
    g.radius[i] = s.radius;
    g.lift_squared[i] = s.lift_squared;
  }
  if (marked_) marks_.back().of[lane] = s.mark;
  ++count_;
  largest_radius_ = std::max(largest_radius_, s.radius);
}

Source SourceSums::operator[](std::size_t i) const {
  const Group& g = groups_[i / lanes];
  const std::size_t lane = i % lanes;
  return {.at = {g.x[lane], g.y[lane], g.z[lane]},
          .weight = g.weight[lane],
          .radius = g.radius[lane],
          .lift_squared = g.lift_squared[lane],
          .mark = marked_ ? marks_[i / lanes].of[lane] : 0};
}

SkeletonSample SourceSums::value_at(const Vec3d& p) const {
  Totals t;
  folds().values(groups_, exponent_, p, t);
  SkeletonSample s;
  s.value = total(t.f);
  s.si_gradient = total(t.S) * -static_cast<double>(exponent_);
  return s;
}

MarkSums SourceSums::marks_at(const Vec3d& p) const {
  MarkTotals t;
  folds().marks(groups_, marks_.data(), exponent_, p, t);
  const double m = exponent_;
  return {.first = total(t.first),
          .second = total(t.second),
          .first_gradient = total(t.first_gradient) * -m,
          .second_gradient = total(t.second_gradient) * -m};
}

double SourceSums::least_within(const Vec3d& p, double rho) const {
  Eight sum;
  folds().least(groups_, exponent_, p, rho, sum);
  return total(sum);
}

SourceSample SourceSums::at(const Vec3d& p) const {
  Totals t;
  folds().slopes(groups_, exponent_, p, t);
  const double m = exponent_, bend = m * (m + 2);
  SourceSample s;
  s.sum.value = total(t.f);
  s.sum.si_gradient = total(t.S) * -m;
  s.sum.gradient = total(t.gradient) * -m;
  s.pull = total(t.k);
  const double k = -m * s.pull, yz = bend * total(t.J[3]), xz = bend * total(t.J[4]), xy = bend * total(t.J[5]);
  s.sum.si_jacobian.rows = {Vec3d{k + bend * total(t.J[0]), xy, xz}, Vec3d{xy, k + bend * total(t.J[1]), yz},
                            Vec3d{xz, yz, k + bend * total(t.J[2])}};
  s.second = total(t.second);
  s.third = total(t.third);
  double inverse = 0;
  for (int i = 0; i < lanes; ++i) inverse = std::max(inverse, t.nearest_inverse[i]);
  s.nearest = 1 / std::sqrt(inverse);
  return s;
}

}  // namespace marrow
