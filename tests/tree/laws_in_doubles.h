// The laws of laws.h for fields that are there in doubles only: blends, and trees that hold them.
//
// A field is anything with a template X value(const Vec3<X>&) const and a rounding(): how far doubles may be off,
// relative to value and slopes.
#pragma once

#include <array>
#include <cmath>
#include <cstdlib>

#include "field/skeleton/second_order.h"
#include "tests/tree/laws.h"

namespace marrow::test {

/// Checks of each law: few in the suite, MARROW_LAW_CHECKS of them at night.
inline std::uint64_t wanted_checks() {
  const char* text = std::getenv("MARROW_LAW_CHECKS");
  return text ? std::strtoull(text, nullptr, 10) : 6000;
}

inline bool holds(const Interval& bounds, double x, double slack) {
  return bounds.lo - slack <= x && x <= bounds.hi + slack;
}

template <class Field>
void expect_enclosures_in_doubles(const Field& field, const Box3& box, Random& random, Checks& checks) {
  const Interval value = field.value(places_in(box));
  const SlopeBounds bounds = field.value(jet_variables(places_in(box)));
  ASSERT_LE(value.lo, value.hi);
  for (int k = 0; k < 6; ++k) {
    const Vec3d p = k == 0 ? box.lower : k == 1 ? box.upper : point_in(box, random);
    const Gradient f = field.value(jet_variables(p));
    const double slack = field.rounding() * (std::fabs(f.value) + steepness(f));
    ASSERT_TRUE(std::isinf(f.value) ? value.hi == f.value : holds(value, f.value, slack))
        << f.value << " is not in " << value.lo << " .. " << value.hi;
    ASSERT_TRUE(std::isinf(f.value) || holds(bounds.value, f.value, slack)) << f.value << " is not in the jet's bounds";
    checks.enclosures += 1;
    if (std::isinf(f.value)) continue;
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_TRUE(holds(bounds.slope[i], f.slope[i], slack + 1e-9 * std::fabs(f.slope[i])))
          << "slope " << f.slope[i] << " is not in " << bounds.slope[i].lo << " .. " << bounds.slope[i].hi;
    checks.enclosures += 1;
  }
}

// Over a piece of a ray the slope's bounds are a Lipschitz bound.
template <class Field>
void expect_ray_enclosures_in_doubles(const Field& field, const Vec3d& origin, Random& random, Checks& checks) {
  const Vec3d direction = normalize(random.vector(1)).vec();
  const double length = pow(10.0, random.between(-6, 0.5));
  const RayBounds t = RayBounds::variable({0, length}, 0);
  const RayBounds bounds = field.value(constant<RayBounds>(origin) + constant<RayBounds>(direction) * t);
  double before = 0, at_before = 0;
  for (int k = 0; k < 3; ++k) {
    const double at = random.between(0, length), f = field.value(origin + direction * at);
    const double slack = field.rounding() * (1 + std::fabs(f)) * 10;
    ASSERT_TRUE(std::isinf(f) || holds(bounds.value, f, slack)) << f;
    checks.enclosures += 1;
    if (k > 0 && std::isfinite(f) && std::isfinite(before)) {
      const Interval change = bounds.slope[0] * (Interval(at) - Interval(at_before));
      ASSERT_TRUE(holds(change, f - before, slack * (1 + std::fabs(before))))
          << f - before << " is not in " << change.lo << " .. " << change.hi;
    }
    before = f;
    at_before = at;
  }
}

// Of fourth order, ahead, behind and to both sides.
struct Rise {
  double middle, roughness;
};
template <class Function>
Rise rise_of(const Function& f, const Vec3d& p, std::size_t axis, double h) {
  const auto at = [&](double step) {
    Vec3d q = p;
    q[axis] += step;
    return f(q);
  };
  const double here = at(0), a = at(h), b = at(-h), far_a = at(2 * h), far_b = at(-2 * h);
  const double ahead = (4 * (a - here) - (far_a - here)) / (2 * h),
               behind = (4 * (here - b) - (here - far_b)) / (2 * h);
  return {(8 * (a - b) - (far_a - far_b)) / (12 * h), std::fabs(ahead - behind)};
}

// Agrees with the differences of one step at least, or there is a kink. The shortest steps are for warps in warps,
// which may turn a field on a length of 1e-7.
enum class Verdict { Agrees, Rough, Wrong };
template <class Function>
Verdict verdict_of(const Function& f, const Vec3d& p, std::size_t axis, double slope, double scale, double tolerance) {
  bool rough = false;
  for (const double step : {0x1p-12, 0x1p-9, 0x1p-15, 0x1p-18, 0x1p-21, 0x1p-24, 0x1p-27, 0x1p-30}) {
    const Rise rise = rise_of(f, p, axis, step);
    if (std::fabs(rise.middle - slope) <= 0.2 * rise.roughness + tolerance * scale && rise.roughness <= 1e-2 * scale)
      return Verdict::Agrees;
    rough = rough || rise.roughness > 1e-2 * scale;
  }
  return rough ? Verdict::Rough : Verdict::Wrong;
}

template <class Field>
void expect_derivatives_in_doubles(const Field& field, const Vec3d& p, bool hessian, Checks& checks) {
  const Gradient jet = field.value(jet_variables(p));
  if (!(jet.value < 20)) return;
  const double size = 1e-3 + jet.value + steepness(jet), tolerance = 1e-7;
  for (std::size_t i = 0; i < 3; ++i) {
    const Verdict v = verdict_of([&](const Vec3d& q) { return field.value(q); }, p, i, jet.slope[i], size, tolerance);
    checks.slopes += 1;
    checks.rough_slopes += v == Verdict::Rough;
    ASSERT_NE(v, Verdict::Wrong) << "slope " << i << ": " << jet.slope[i];
  }
  if (!hessian) return;
  const HessianJet second = field.value(variables_at<HessianJet>(p));
  ASSERT_NEAR(second.value, jet.value, 1e-10 * size);
  double scale = size;
  for (const double c : second.curvature) scale += std::fabs(c);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = HessianJet::at[k];
    const std::size_t component = j;
    const auto slope = [&](const Vec3d& q) { return field.value(jet_variables(q)).slope[component]; };
    const Verdict v = verdict_of(slope, p, i, second.curvature[k], scale, 10 * tolerance);
    checks.curvatures += 1;
    checks.rough_curvatures += v == Verdict::Rough;
    ASSERT_NE(v, Verdict::Wrong) << "curvature " << k << ": " << second.curvature[k];
  }
}

}  // namespace marrow::test
