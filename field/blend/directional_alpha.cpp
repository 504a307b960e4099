// Running tensors over strands, forward and backward.
#include "field/blend/directional_alpha.h"

#include <cmath>
#include <vector>

namespace marrow {
namespace {

constexpr int power = 8;

struct Exponents {
  std::size_t i, j, k;
  double count;  // 8! / (i! j! k!)
};

constexpr auto exponents = [] {
  std::array<double, power + 1> factorial{1};
  for (std::size_t i = 1; i <= power; ++i) factorial[i] = factorial[i - 1] * static_cast<double>(i);
  std::array<Exponents, DirectionTensor::size> all{};
  std::size_t at = 0;
  for (std::size_t i = 0; i <= power; ++i)
    for (std::size_t j = 0; i + j <= power; ++j) {
      const std::size_t k = power - i - j;
      all[at++] = {i, j, k, factorial[power] / (factorial[i] * factorial[j] * factorial[k])};
    }
  return all;
}();

using Powers = std::array<double, power + 1>;
Powers powers_of(double x) {
  Powers all;
  all[0] = 1;
  for (std::size_t i = 1; i <= power; ++i) all[i] = all[i - 1] * x;
  return all;
}

// A strand made ready: u of length 1 (or 0), A and B of its bounds.
struct Hair {
  double f, span, least;
  Vec3d u;
  double inverse_length;  // of the direction that was given; 0 without one
};

Hair hair_of(const Strand& s) {
  const double length = marrow::length(s.direction);
  const bool has_direction = length > 0 && std::isfinite(length);
  return {s.field, s.bounds.most - s.bounds.least, s.bounds.least, has_direction ? s.direction / length : Vec3d{},
          has_direction ? 1 / length : 0};
}

// Sums over the strands on one side of a strand.
class Side {
 public:
  // sum_j f_j 2 gamma_ij, and its slope by u_i
  double angles(const Hair& hair) const {
    return hair.span * plain_.along(hair.u) + spans_.along(hair.u) + hair.least * field_ + least_;
  }
  Vec3d slope(const Hair& hair) const { return plain_.slope_along(hair.u) * hair.span + spans_.slope_along(hair.u); }
  double field() const { return field_; }
  void add(const Hair& hair) {
    plain_.add(hair.f, hair.u);
    spans_.add(hair.f * hair.span, hair.u);
    field_ += hair.f;
    least_ += hair.f * hair.least;
  }

 private:
  DirectionTensor plain_, spans_;
  double field_ = 0, least_ = 0;
};

// What the strands on one side give to the numerator's and the denominator's gradients.
void add_slopes(const Hair& hair, const Strand& strand, const Side& side, Vec3d& numerator, Vec3d& denominator) {
  numerator += strand.field_gradient * side.angles(hair);
  denominator += strand.field_gradient * (2 * side.field());
  // u = m / |m|: du = (I - u u^T) dm / |m|
  const Vec3d by_u = side.slope(hair);
  const Vec3d by_m = (by_u - hair.u * dot(hair.u, by_u)) * (hair.f * hair.inverse_length);
  numerator += strand.direction_jacobian.transposed_times(by_m);
}

AlphaSample mean_of_most(std::span<const Strand> strands) {
  double sum = 0, field = 0;
  for (const Strand& s : strands) {
    sum += s.field * s.bounds.most;
    field += s.field;
  }
  return {.value = field > 0 ? sum / field : strands.empty() ? 0 : strands.front().bounds.most};
}

}  // namespace

void DirectionTensor::add(double weight, const Vec3d& u) {
  const Powers x = powers_of(u.x), y = powers_of(u.y), z = powers_of(u.z);
  for (std::size_t b = 0; b < size; ++b)
    components_[b] += weight * (x[exponents[b].i] * y[exponents[b].j] * z[exponents[b].k]);
}

double DirectionTensor::along(const Vec3d& v) const {
  const Powers x = powers_of(v.x), y = powers_of(v.y), z = powers_of(v.z);
  double sum = 0;
  for (std::size_t b = 0; b < size; ++b)
    sum += exponents[b].count * components_[b] * (x[exponents[b].i] * y[exponents[b].j] * z[exponents[b].k]);
  return sum;
}

Vec3d DirectionTensor::slope_along(const Vec3d& v) const {
  const Powers x = powers_of(v.x), y = powers_of(v.y), z = powers_of(v.z);
  Vec3d sum;
  for (std::size_t b = 0; b < size; ++b) {
    const auto [i, j, k, count] = exponents[b];
    const double weight = count * components_[b];
    if (i > 0) sum.x += weight * static_cast<double>(i) * (x[i - 1] * y[j] * z[k]);
    if (j > 0) sum.y += weight * static_cast<double>(j) * (x[i] * y[j - 1] * z[k]);
    if (k > 0) sum.z += weight * static_cast<double>(k) * (x[i] * y[j] * z[k - 1]);
  }
  return sum;
}

AlphaSample directional_alpha(std::span<const Strand> strands, bool with_gradient) {
  std::vector<Hair> hairs;
  hairs.reserve(strands.size());
  for (const Strand& s : strands) hairs.push_back(hair_of(s));
  double numerator = 0, denominator = 0;
  Vec3d numerator_slope, denominator_slope;
  Side before;
  for (std::size_t i = 0; i < hairs.size(); ++i) {
    numerator += hairs[i].f * before.angles(hairs[i]);
    denominator += 2 * hairs[i].f * before.field();
    if (with_gradient) add_slopes(hairs[i], strands[i], before, numerator_slope, denominator_slope);
    before.add(hairs[i]);
  }
  if (!(denominator > 0)) return mean_of_most(strands);
  AlphaSample alpha{.value = numerator / denominator};
  if (!with_gradient) return alpha;
  Side after;
  for (std::size_t i = hairs.size(); i-- > 0;) {
    add_slopes(hairs[i], strands[i], after, numerator_slope, denominator_slope);
    after.add(hairs[i]);
  }
  alpha.gradient = (numerator_slope - denominator_slope * alpha.value) / denominator;
  return alpha;
}

}  // namespace marrow
