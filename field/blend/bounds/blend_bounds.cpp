#include "field/blend/bounds/blend_bounds.h"

#include <algorithm>

#include "field/blend/bounds/correction/correction_bounds.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;
const Vec3<Interval> unknown{Interval::everything(), Interval::everything(), Interval::everything()};

// C is monotone in alpha at each f and G, so that the two ends bound it between them (trace/README.md); but not with
// cavity under the compact kernel.
Interval corrected(const BlendField& blend, const Correction& least, const Interval& alpha, const Interval& f,
                   const Interval& G) {
  if (alpha.lo == alpha.hi) return correction_bounds(least, f, G);
  const Correction most = correction_at(blend, alpha.hi);
  if (blend.kernel == KernelFamily::Compact && blend.cavity)
    return correction_bounds_between(*least.bounded(), *most.bounded(), f, G);
  return hull(correction_bounds(least, f, G), correction_bounds(most, f, G));
}

// grad C = dC/df grad f + dC/dG grad G + dC/dalpha grad alpha with dG/dp_j = S . dS/dp_j / G, where |S_i / G| <= 1.
Vec3<Interval> gradient_of(const SumBounds& sum, const PartialBounds& by, const Vec3<Interval>& S, const Interval& G,
                           const Vec3<Interval>& alpha_gradient) {
  const Vec3<Interval> f_gradient = sum.gradient();
  Vec3<Interval> gradient;
  for (std::size_t j = 0; j < 3; ++j) {
    Interval G_slope;
    for (std::size_t i = 0; i < 3; ++i) G_slope += clamped(S[i] / G, {-1, 1}) * sum.J(i, j);
    gradient[j] = by.df * f_gradient[j] + by.dG * G_slope + by.dalpha * alpha_gradient[j];
  }
  return gradient;
}

// The same along a stretch.
Interval slope_along(const SumBounds& sum, const PartialBounds& by, const Vec3<Interval>& S, const Interval& G,
                     const Vec3<Interval>& alpha_gradient) {
  Interval G_slope, alpha_slope;
  for (std::size_t i = 0; i < 3; ++i) {
    G_slope += clamped(S[i] / G, {-1, 1}) * sum.S_along(i);
    if (alpha_gradient[i] == Interval(0)) continue;  // stays 0, as dC/dalpha may not be known
    const double along = sum.stretch()->direction[i], turn = sum.stretch()->turn;
    alpha_slope += alpha_gradient[i] * Interval(along - turn, along + turn);
  }
  return by.df * sum.f_along() + by.dG * G_slope + by.dalpha * alpha_slope;
}

// Up to this field the operator leaves lone skeletons alone.   [bounded_correction.h]
double largest_left_alone(const Correction& least) {
  constexpr double of_top = 0.85;
  return least.bounded() ? of_top * least.bounded()->curve().top_field() : inf;
}

// C = f, to within what the operator rounds. Its slopes need none of S, which may jump.
BlendBounds bounds_on_curve(const SumBounds& sum) {
  constexpr double rounding = 1e-12;
  const Interval f = sum.f();
  const double by = rounding * (1 + f.hi);
  BlendBounds b{.value = {std::max(0.0, f.lo - by), f.hi + by}, .gradient = unknown};
  if (!sum.has_gradient()) return b;
  if (sum.stretch() != nullptr) b.along = sum.f_along();
  else b.gradient = sum.gradient();
  return b;
}

}  // namespace

BlendBounds blend_bounds(const BlendField& blend, const Box3& box, Wanted wanted, const Within& within) {
  if (!is_finite(box.center()) || !is_finite(box.size())) return {{0, inf}, unknown};
  const SumBounds sum(blend, box, wanted, within);
  const AngleBounds angle = alpha_bounds(blend, sum, box);
  return blend_bounds(blend, sum, angle, correction_at(blend, angle.value.lo));
}

BlendBounds blend_bounds(const BlendField& blend, const SumBounds& sum, const AngleBounds& angle,
                         const Correction& least) {
  const Interval& alpha = angle.value;
  const Interval f = sum.f();
  if (sum.unbounded()) {
    // C is isotone in G and, at G = 0, in f. Without cavity it falls in f there below alpha = 0.
    if (alpha.lo < 0 && !blend.cavity) return {{0, inf}, unknown};
    return {{corrected(blend, least, alpha, {f.lo, f.lo}, {0, 0}).lo, inf}, unknown};
  }
  if (sum.is_on_curve() && alpha.lo >= 0 && f.hi < largest_left_alone(least)) return bounds_on_curve(sum);
  const Vec3<Interval> S = sum.S();
  const Interval by_parts = sqrt(square(S.x) + square(S.y) + square(S.z));
  const Interval G(by_parts.lo, std::min(by_parts.hi, std::max(by_parts.lo, sum.longest_S())));
  BlendBounds b{.value = corrected(blend, least, alpha, f, G), .gradient = unknown};
  if (!sum.has_slopes()) return b;
  const PartialBounds by = partial_bounds(blend, least, alpha, b.value, f, G);
  if (sum.stretch() != nullptr) b.along = slope_along(sum, by, S, G, angle.gradient);
  else b.gradient = gradient_of(sum, by, S, G, angle.gradient);
  return b;
}

}  // namespace marrow
