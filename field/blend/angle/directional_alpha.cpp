// Few strands pair by pair; many by running tensors, forward and backward.
#include "field/blend/angle/directional_alpha.h"

#include <cmath>
#include <vector>

#include "field/blend/angle/direction_tensor.h"
#include "field/blend/angle/least_direction.h"

namespace marrow {
namespace {

// A strand made ready: u of length 1 (or 0), A and B of its bounds.
struct Hair {
  double f, span, least;
  Vec3d u;
  double inverse_length;  // of the direction that was given; 0 without one
};

Hair hair_of(const Strand& s) {
  const double length = marrow::length(s.direction);
  const bool has_direction = length > least_direction * s.field && std::isfinite(length);
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
  DirectionTensor<double> plain_, spans_;
  double field_ = 0, least_ = 0;
};

// What the other strands give to the numerator's and the denominator's gradients through one of them: `angles` is the
// sum of their f_j 2 gamma_ij, `by_u` its slope by u_i, `field` the sum of f_j.
struct Slopes {
  Vec3d numerator{}, denominator{};

  void add(const Hair& hair, const Strand& strand, double angles, const Vec3d& by_u, double field) {
    numerator += strand.field_gradient * angles;
    denominator += strand.field_gradient * (2 * field);
    // u = m / |m|: du = (I - u u^T) dm / |m|
    const Vec3d by_m = (by_u - hair.u * dot(hair.u, by_u)) * (hair.f * hair.inverse_length);
    numerator += strand.direction_jacobian.transposed_times(by_m);
  }
  void add(const Hair& hair, const Strand& strand, const Side& side) {
    add(hair, strand, side.angles(hair), side.slope(hair), side.field());
  }
  AlphaSample of_mean(double alpha, double weights) const {
    return {.value = alpha, .gradient = (numerator - denominator * alpha) / weights};
  }
};

AlphaSample mean_of_most(std::span<const Strand> strands) {
  double sum = 0, field = 0;
  for (const Strand& s : strands) {
    sum += s.field * s.bounds.most;
    field += s.field;
  }
  return {.value = field > 0 ? sum / field : strands.empty() ? 0 : strands.front().bounds.most};
}

// Of a strand: sums over all others, as Slopes::add() takes them.
struct Others {
  double angles = 0, field = 0;
  Vec3d by_u{};

  void add(const Hair& other, double gamma, double by_cosine) {
    angles += other.f * (2 * gamma);
    field += other.f;
    by_u += other.u * (other.f * (2 * by_cosine));
  }
};

AlphaSample over_pairs(std::span<const Strand> strands, const std::vector<Hair>& hairs, bool with_gradient) {
  std::vector<Others> others(hairs.size());
  double numerator = 0, denominator = 0;
  for (std::size_t i = 0; i < hairs.size(); ++i) {
    numerator += hairs[i].f * others[i].angles;
    denominator += 2 * hairs[i].f * others[i].field;
    for (std::size_t j = i + 1; j < hairs.size(); ++j) {
      const double span = 0.5 * (hairs[i].span + hairs[j].span), cosine = dot(hairs[i].u, hairs[j].u);
      const double seventh = span * integer_power(cosine, 7);
      const double gamma = seventh * cosine + 0.5 * (hairs[i].least + hairs[j].least);
      others[i].add(hairs[j], gamma, 8 * seventh);
      others[j].add(hairs[i], gamma, 8 * seventh);
    }
  }
  if (!(denominator > 0)) return mean_of_most(strands);
  if (!with_gradient) return {.value = numerator / denominator};
  Slopes slopes;
  for (std::size_t i = 0; i < hairs.size(); ++i)
    slopes.add(hairs[i], strands[i], others[i].angles, others[i].by_u, others[i].field);
  return slopes.of_mean(numerator / denominator, denominator);
}

AlphaSample by_tensors(std::span<const Strand> strands, const std::vector<Hair>& hairs, bool with_gradient) {
  double numerator = 0, denominator = 0;
  Slopes slopes;
  Side before;
  for (std::size_t i = 0; i < hairs.size(); ++i) {
    numerator += hairs[i].f * before.angles(hairs[i]);
    denominator += 2 * hairs[i].f * before.field();
    if (with_gradient) slopes.add(hairs[i], strands[i], before);
    before.add(hairs[i]);
  }
  if (!(denominator > 0)) return mean_of_most(strands);
  if (!with_gradient) return {.value = numerator / denominator};
  Side after;
  for (std::size_t i = hairs.size(); i-- > 0;) {
    slopes.add(hairs[i], strands[i], after);
    after.add(hairs[i]);
  }
  return slopes.of_mean(numerator / denominator, denominator);
}

}  // namespace

AlphaSample directional_alpha(std::span<const Strand> strands, bool with_gradient) {
  constexpr std::size_t few = 64;
  std::vector<Hair> hairs;
  hairs.reserve(strands.size());
  for (const Strand& s : strands) hairs.push_back(hair_of(s));
  return hairs.size() > few ? by_tensors(strands, hairs, with_gradient) : over_pairs(strands, hairs, with_gradient);
}

// One sweep: derivatives come with the numbers.
HessianJet directional_alpha(std::span<const SecondOrderStrand> strands) {
  DirectionTensor<HessianJet> plain, spans;
  HessianJet numerator, denominator, field_before, least_before;
  for (const SecondOrderStrand& s : strands) {
    const double span = s.bounds.most - s.bounds.least, least = s.bounds.least;
    const HessianJet size = length(s.direction);
    const bool has_direction = size.value > least_direction * s.field.value && std::isfinite(size.value);
    const Vec3<HessianJet> u = has_direction ? s.direction / size : Vec3<HessianJet>{};
    numerator += s.field * (span * plain.along(u) + spans.along(u) + least * field_before + least_before);
    denominator += 2.0 * s.field * field_before;
    plain.add(s.field, u);
    spans.add(s.field * span, u);
    field_before += s.field;
    least_before += s.field * least;
  }
  if (denominator.value > 0) return numerator / denominator;
  std::vector<Strand> plain_strands;
  for (const SecondOrderStrand& s : strands)
    plain_strands.push_back(
        {.field = s.field.value, .field_gradient = {}, .direction = {}, .direction_jacobian = {}, .bounds = s.bounds});
  return mean_of_most(plain_strands).value;
}

}  // namespace marrow
