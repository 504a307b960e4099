// The sums in eight lanes: each lane adds its own sources in their order, and the lanes are added in theirs, so that
// nothing depends on how wide the machine's vectors are.
#include "field/blend/sources/source_sums.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace marrow {
namespace {

using Lanes = double __attribute__((vector_size(64)));
using Group = SourceSums::Group;
using Marks = SourceSums::Marks;
static_assert(sizeof(Lanes) == SourceSums::lanes * sizeof(double));

struct Totals {
  Lanes f, S[3], gradient[3], k, J[6], second, third, nearest_inverse;
};

[[gnu::always_inline]] inline Lanes load(const double (&v)[SourceSums::lanes]) {
  return *reinterpret_cast<const Lanes*>(&v[0]);
}

[[gnu::always_inline]] inline void take_root(Lanes& x) {
  for (int i = 0; i < SourceSums::lanes; ++i) x[i] = std::sqrt(x[i]);
}

// The factors -m and m (m+2) of derivatives are left to the end.
template <bool WithSlopes>
[[gnu::always_inline]] inline void fold(std::span<const Group> groups, int m, const Vec3d& p, Totals& out) {
  Totals t{};
  for (const Group& g : groups) {
    const Lanes x = p.x - load(g.x), y = p.y - load(g.y), z = p.z - load(g.z), tau = load(g.radius);
    const Lanes inverse = 1.0 / (x * x + y * y + z * z + load(g.lift_squared));
    Lanes root = inverse, f = load(g.weight);
    if (WithSlopes || m % 2 != 0) take_root(root);
    for (int i = 0; i < m / 2; ++i) f *= inverse;
    if (m % 2 != 0) f *= root;
    const Lanes steep = f * inverse, k = steep * tau;
    t.f += f;
    t.S[0] += k * x;
    t.S[1] += k * y;
    t.S[2] += k * z;
    if constexpr (WithSlopes) {
      t.gradient[0] += steep * x;
      t.gradient[1] += steep * y;
      t.gradient[2] += steep * z;
      const Lanes bent = k * inverse, bx = bent * x, by = bent * y;
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
  out = t;
}

[[gnu::target("avx512f,prefer-vector-width=512")]] void values_512(std::span<const Group> g, int m, const Vec3d& p,
                                                                   Totals& out) {
  fold<false>(g, m, p, out);
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void slopes_512(std::span<const Group> g, int m, const Vec3d& p,
                                                                   Totals& out) {
  fold<true>(g, m, p, out);
}
[[gnu::target("avx2")]] void values_256(std::span<const Group> g, int m, const Vec3d& p, Totals& out) {
  fold<false>(g, m, p, out);
}
[[gnu::target("avx2")]] void slopes_256(std::span<const Group> g, int m, const Vec3d& p, Totals& out) {
  fold<true>(g, m, p, out);
}
void values_128(std::span<const Group> g, int m, const Vec3d& p, Totals& out) { fold<false>(g, m, p, out); }
void slopes_128(std::span<const Group> g, int m, const Vec3d& p, Totals& out) { fold<true>(g, m, p, out); }

// As far away as within rho of p they can be.
[[gnu::always_inline]] inline void fold_least(std::span<const Group> groups, int m, const Vec3d& p, double rho,
                                              Lanes& out) {
  Lanes sum{};
  for (const Group& g : groups) {
    const Lanes x = p.x - load(g.x), y = p.y - load(g.y), z = p.z - load(g.z);
    Lanes distance = x * x + y * y + z * z + load(g.lift_squared), f = load(g.weight);
    take_root(distance);
    const Lanes inverse = 1.0 / (distance + rho);
    for (int i = 0; i < m; ++i) f *= inverse;
    sum += f;
  }
  out = sum;
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void least_512(std::span<const Group> g, int m, const Vec3d& p,
                                                                  double rho, Lanes& out) {
  fold_least(g, m, p, rho, out);
}
[[gnu::target("avx2")]] void least_256(std::span<const Group> g, int m, const Vec3d& p, double rho, Lanes& out) {
  fold_least(g, m, p, rho, out);
}
void least_128(std::span<const Group> g, int m, const Vec3d& p, double rho, Lanes& out) {
  fold_least(g, m, p, rho, out);
}

struct MarkTotals {
  Lanes first, second, first_gradient[3], second_gradient[3];
};

// The factor -m of gradients is left to the end.
[[gnu::always_inline]] inline void fold_marks(std::span<const Group> groups, const Marks* marks, int m, const Vec3d& p,
                                              MarkTotals& out) {
  MarkTotals t{};
  for (const Group& g : groups) {
    const Lanes x = p.x - load(g.x), y = p.y - load(g.y), z = p.z - load(g.z), mark = load((marks++)->of);
    const Lanes inverse = 1.0 / (x * x + y * y + z * z + load(g.lift_squared));
    Lanes f = load(g.weight) * mark;
    if (m % 2 != 0) {
      Lanes root = inverse;
      take_root(root);
      f *= root;
    }
    for (int i = 0; i < m / 2; ++i) f *= inverse;
    const Lanes squared = f * mark, steep = f * inverse, steep_squared = squared * inverse;
    t.first += f;
    t.second += squared;
    t.first_gradient[0] += steep * x;
    t.first_gradient[1] += steep * y;
    t.first_gradient[2] += steep * z;
    t.second_gradient[0] += steep_squared * x;
    t.second_gradient[1] += steep_squared * y;
    t.second_gradient[2] += steep_squared * z;
  }
  out = t;
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void marks_512(std::span<const Group> g, const Marks* marks, int m,
                                                                  const Vec3d& p, MarkTotals& out) {
  fold_marks(g, marks, m, p, out);
}
[[gnu::target("avx2")]] void marks_256(std::span<const Group> g, const Marks* marks, int m, const Vec3d& p,
                                       MarkTotals& out) {
  fold_marks(g, marks, m, p, out);
}
void marks_128(std::span<const Group> g, const Marks* marks, int m, const Vec3d& p, MarkTotals& out) {
  fold_marks(g, marks, m, p, out);
}

struct Folds {
  void (*values)(std::span<const Group>, int, const Vec3d&, Totals&);
  void (*slopes)(std::span<const Group>, int, const Vec3d&, Totals&);
  void (*least)(std::span<const Group>, int, const Vec3d&, double, Lanes&);
  void (*marks)(std::span<const Group>, const Marks*, int, const Vec3d&, MarkTotals&);
};

const Folds& folds() {
  static const Folds best = __builtin_cpu_supports("avx512f") ? Folds{values_512, slopes_512, least_512, marks_512}
                            : __builtin_cpu_supports("avx2")  ? Folds{values_256, slopes_256, least_256, marks_256}
                                                              : Folds{values_128, slopes_128, least_128, marks_128};
  return best;
}

double total(const Lanes& v) {
  double sum = 0;
  for (int i = 0; i < SourceSums::lanes; ++i) sum += v[i];
  return sum;
}
Vec3d total(const Lanes (&v)[3]) { return {total(v[0]), total(v[1]), total(v[2])}; }

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
  Lanes sum;
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
