#include "field/blend/bounds/sum/nearest_places.h"

#include <algorithm>
#include <cmath>

#include "field/kernel/profile.h"

namespace marrow::nearest_places {
namespace {

Interval padded(double a, double b) {
  const Interval x{std::min(a, b), std::max(a, b)};
  return {x.lo - 1e-12 * std::fabs(x.lo), x.hi + 1e-12 * std::fabs(x.hi)};
}

// All derivatives of the kernels by y = e^2 are monotone. As e is stationary at q, grad y = 2 (p - q) / radius^2;
// S = 2 k'(y) (p - q) / radius.
std::optional<PrimitiveSlopes> slopes_from(const Place& q, const Interval& y, const Profile& profile) {
  const ProfileSample near = profile.at(y.lo), far = profile.at(y.hi);
  if (!std::isfinite(near.curvature)) return {};
  const Interval over = Interval(1 / profile.normalisation()) / q.radius;
  const Interval slope = 2 * padded(near.slope, far.slope) * over;
  const Interval bend = 4 * padded(near.curvature, far.curvature) * over / square(q.radius);
  const Span& v = q.to_point;
  PrimitiveSlopes s;
  for (std::size_t i = 0; i < 3; ++i) {
    s.gradient[i] = slope / q.radius * v[i];
    for (std::size_t j = 0; j < 3; ++j)
      s.J[i][j] = bend * (i == j ? square(v[i]) : v[i] * v[j]) + slope * q.turns[i][j];
  }
  return s;
}

PrimitiveSlopes hull(const PrimitiveSlopes& a, const PrimitiveSlopes& b) {
  PrimitiveSlopes both;
  for (std::size_t i = 0; i < 3; ++i) {
    both.gradient[i] = hull(a.gradient[i], b.gradient[i]);
    for (std::size_t j = 0; j < 3; ++j) both.J[i][j] = hull(a.J[i][j], b.J[i][j]);
  }
  return both;
}

}  // namespace

std::optional<PrimitiveSlopes> Places::slopes(const Kernel& kernel) const {
  const Profile profile(kernel, 0);
  double nearest = rounding::inf;
  for (std::size_t i = 0; i < count_; ++i)
    if (all_[i].is_real) nearest = std::min(nearest, all_[i].scaled_squared().hi);
  std::optional<PrimitiveSlopes> sum;
  for (std::size_t i = 0; i < count_; ++i) {
    const Interval y = all_[i].scaled_squared();
    if (y.lo > nearest) continue;
    if (!(all_[i].radius.lo > 0) || (kernel.family == KernelFamily::Inverse && !(y.lo > 0))) return {};
    const auto own = slopes_from(all_[i], y, profile);
    if (!own) return {};
    sum = sum ? hull(*sum, *own) : *own;
  }
  return sum;
}

}  // namespace marrow::nearest_places
