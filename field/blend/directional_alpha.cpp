// Running tensors over strands, forward and backward.
#include "field/blend/directional_alpha.h"

#include <cmath>
#include <vector>

#include "field/blend/direction_tensor.h"
#include "field/blend/least_direction.h"

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
