// What every field must keep, whatever it computes: derivatives and enclosures that belong to its values.
//
// A field is anything with a template X value(const Vec3<X>&) const. The values themselves are compared with those of
// the same formula in higher precision, which also stand for the exact ones in enclosures.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <queue>

#include <gtest/gtest.h>

#include "field/math/box3.h"
#include "field/number/places_in.h"
#include "field/number/variables_at.h"
#include "tests/field/random.h"
#include "tests/number/precise.h"

namespace marrow::test {

using Gradient = Jet<double, 3>;
using PreciseGradient = Jet<Precise, 3>;
using SlopeBounds = Jet<Interval, 3>;
using RayBounds = Jet<Interval, 1>;

/// How much was checked, so that no law is kept by default.
struct Checks {
  std::uint64_t enclosures = 0, slopes = 0, curvatures = 0;
  std::uint64_t rough_slopes = 0, rough_curvatures = 0;  ///< tried at kinks, where differences tell nothing
};

template <class T>
Vec3<Jet<T, 3>> jet_variables(const Vec3<T>& p) {
  return variables_at<Jet<T, 3>>(p);
}
inline Vec3<Precise> precise(const Vec3d& p) { return {p.x, p.y, p.z}; }
inline bool contains(const Interval& bounds, Precise x) { return bounds.lo <= x.v && x.v <= bounds.hi; }

inline Vec3d point_in(const Box3& box, Random& random) {
  Vec3d p;
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = std::clamp(random.between(box.lower[i], box.upper[i]), box.lower[i], box.upper[i]);
  return p;
}
/// A box at a corner, from a point to some units wide.
inline Box3 random_box(const Vec3d& corner, Random& random) {
  const double size = random.between(0, 1) < 0.1 ? 0 : pow(10.0, random.between(-9, 0.5));
  return {corner, corner + Vec3d{random.between(0, size), random.between(0, size), random.between(0, size)}};
}

/// Enclosures over a box hold the values and slopes of points in it, and differences between them.
template <class Field>
void expect_enclosures(const Field& field, const Box3& box, int points, Random& random, Checks& checks) {
  const Interval value = field.value(places_in(box));
  const SlopeBounds bounds = field.value(jet_variables(places_in(box)));
  Vec3d before{};
  Precise value_before;
  for (int k = 0; k < points; ++k) {
    Vec3d p = point_in(box, random);
    if (k == 0) p = box.lower;
    if (k == 1) p = box.upper;
    const Precise exact = field.value(precise(p));
    const double rounded = field.value(p);
    ASSERT_TRUE(value.contains(rounded) && bounds.value.contains(rounded))
        << rounded << " is not in " << value.lo << " .. " << value.hi;
    ASSERT_TRUE(contains(value, exact) && contains(bounds.value, exact))
        << static_cast<double>(exact.v) << " (exact) is not in " << value.lo << " .. " << value.hi;
    const PreciseGradient slopes = field.value(jet_variables(precise(p)));
    Interval change = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_TRUE(contains(bounds.slope[i], slopes.slope[i]))
          << "slope " << i << ": " << static_cast<double>(slopes.slope[i].v) << " is not in " << bounds.slope[i].lo
          << " .. " << bounds.slope[i].hi;
      change += bounds.slope[i] * (Interval(p[i]) - Interval(before[i]));
    }
    if (k > 0) {
      const Precise difference = exact - value_before;
      const long double slack = 1e-15L * (1 + std::fabs(exact.v));  // constants of operators may be rounded
      ASSERT_TRUE(change.lo - slack <= difference.v && difference.v <= change.hi + slack)
          << "the change " << static_cast<double>(difference.v) << " is not in " << change.lo << " .. " << change.hi;
    }
    before = p;
    value_before = exact;
    checks.enclosures += 2;
  }
}

/// The same along a piece of a ray, with one variable.
template <class Field>
void expect_ray_enclosures(const Field& field, const Vec3d& origin, int points, Random& random, Checks& checks) {
  const Vec3d direction = normalize(random.vector(1)).vec();
  const double length = pow(10.0, random.between(-9, 0.5));
  const RayBounds t = RayBounds::variable({0, length}, 0);
  const Vec3<RayBounds> piece = constant<RayBounds>(origin) + constant<RayBounds>(direction) * t;
  const RayBounds bounds = field.value(piece);
  for (int k = 0; k < points; ++k) {
    const Precise at = random.between(0, length);
    const Vec3<Precise> p = precise(origin) + precise(direction) * at;
    const PreciseGradient exact = field.value(jet_variables(p));
    Precise slope = 0;
    for (std::size_t i = 0; i < 3; ++i) slope += exact.slope[i] * Precise(direction[i]);
    ASSERT_TRUE(contains(bounds.value, exact.value)) << "ray: " << static_cast<double>(exact.value.v) << " is not in "
                                                     << bounds.value.lo << " .. " << bounds.value.hi;
    const long double slack = 1e-17L * (1 + std::fabs(slope.v));  // of the higher precision itself
    ASSERT_TRUE(bounds.slope[0].lo - slack <= slope.v && slope.v <= bounds.slope[0].hi + slack)
        << "ray slope " << static_cast<double>(slope.v) << " is not in " << bounds.slope[0].lo << " .. "
        << bounds.slope[0].hi;
    checks.enclosures += 1;
  }
}

/// Steps of differences, the usual one first. A step that is too wide sees higher derivatives, one that is too narrow
/// rounding (64 bits of mantissa over the step: 2^-42 for the first); a right derivative agrees at one of them at
/// least, a wrong one at none.
inline constexpr std::array difference_steps{0x1p-22, 0x1p-18, 0x1p-26, 0x1p-14};

/// Central differences of higher precision.
template <class Function>
double central_difference(const Function& f, const Vec3d& p, std::size_t axis, double step) {
  Vec3d ahead = p, behind = p;
  ahead[axis] += step;
  behind[axis] -= step;
  return static_cast<double>((f(ahead).v - f(behind).v) / (static_cast<long double>(ahead[axis]) - behind[axis]));
}

/// How far a value moves when a point in a scene of some units is rounded.
inline double steepness(const Gradient& f) {
  return std::fabs(f.slope[0]) + std::fabs(f.slope[1]) + std::fabs(f.slope[2]);
}

/// Whether the derivative `slope` is that of differences, for one step; both must lie in the bounds of the slopes
/// within the step (mean value theorem), so that a difference outside is a fault of the bounds.
struct SlopeVerdict {
  bool bounded = true;  ///< both are in the bounds
  bool rough = false;   ///< the bounds tell nothing: a kink, or useless
  bool agrees = false;
  double difference = 0;
};
template <class Field>
SlopeVerdict verdict_on_slope(const Field& field, const Vec3d& p, std::size_t axis, double slope, double step) {
  constexpr double kink = 1e-2;
  Box3 around{p, p};
  around.lower[axis] -= step;
  around.upper[axis] += step;
  const Interval range = field.value(jet_variables(places_in(around))).slope[axis];
  const double scale = 1 + std::fabs(slope);
  SlopeVerdict v;
  v.difference = central_difference([&](const Vec3d& q) { return field.value(precise(q)); }, p, axis, step);
  const double slack = 1e-9 * scale;
  const auto holds = [&](double x) { return range.lo - slack <= x && x <= range.hi + slack; };
  v.bounded = holds(slope) && holds(v.difference);
  v.rough = !(range.width() < kink * scale);
  v.agrees = std::fabs(slope - v.difference) <= 1e-3 * range.width() + slack;
  return v;
}

/// The gradient is that of differences. `rough` counts where the slopes within a step differ much: there is a kink, or
/// the enclosures are useless; the mean value theorem is held against those too.
template <class Field>
void expect_gradient(const Field& field, const Vec3d& p, Checks& checks) {
  const Gradient jet = field.value(jet_variables(p));
  const double value = field.value(p);
  ASSERT_NEAR(jet.value, value, 1e-14 * (1 + std::fabs(value) + steepness(jet)));
  for (std::size_t i = 0; i < 3; ++i) {
    ++checks.slopes;
    SlopeVerdict v;
    for (const double step : difference_steps) {
      v = verdict_on_slope(field, p, i, jet.slope[i], step);
      ASSERT_TRUE(v.bounded) << "slope " << i
                             << " or its difference is not in the bounds of the slopes: " << jet.slope[i] << ", "
                             << v.difference;
      if (v.rough || v.agrees) break;
    }
    checks.rough_slopes += v.rough;
    ASSERT_TRUE(v.rough || v.agrees) << "slope " << i << " is " << jet.slope[i] << ", the difference " << v.difference;
  }
}

/// A row of the Hessian from differences of the gradient to either side.
struct Bend {
  std::array<double, 3> rise, fall;
  double middle(std::size_t j) const { return 0.5 * (rise[j] + fall[j]); }
  double change(std::size_t j) const { return std::fabs(rise[j] - fall[j]); }
};
template <class Field>
Bend bend_of(const Field& field, const Vec3d& p, const PreciseGradient& here, std::size_t axis, double step) {
  const auto shifted = [&](double h) {
    Vec3d q = p;
    q[axis] += h;
    return field.value(jet_variables(precise(q)));
  };
  const PreciseGradient behind = shifted(-step), ahead = shifted(step);
  const long double before = static_cast<long double>(p[axis]) - (p[axis] - step);
  const long double after = static_cast<long double>(p[axis] + step) - p[axis];
  Bend bend;
  for (std::size_t j = 0; j < 3; ++j) {
    bend.rise[j] = static_cast<double>((ahead.slope[j].v - here.slope[j].v) / after);
    bend.fall[j] = static_cast<double>((here.slope[j].v - behind.slope[j].v) / before);
  }
  return bend;
}

/// The Hessian is that of differences of the gradient; where those to both sides differ much there is a kink.
template <class Field>
void expect_hessian(const Field& field, const Vec3d& p, Checks& checks) {
  constexpr double kink = 1e-2;
  const HessianJet jet = field.value(variables_at<HessianJet>(p));
  const Gradient gradient = field.value(jet_variables(p));
  ASSERT_NEAR(jet.value, gradient.value, 1e-13 * (1 + std::fabs(jet.value) + steepness(gradient)));
  for (std::size_t i = 0; i < 3; ++i)
    ASSERT_NEAR(jet.slope[i], gradient.slope[i], 1e-10 * (1 + std::fabs(gradient.slope[i]))) << "slope " << i;
  const PreciseGradient here = field.value(jet_variables(precise(p)));
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<bool, 3> rough{}, agrees{};
    Bend bend;
    for (const double step : difference_steps) {
      bend = bend_of(field, p, here, i, step);
      for (std::size_t k = 0; k < 6; ++k) {
        const auto [row, j] = HessianJet::at[k];
        if (row != i || rough[j] || agrees[j]) continue;
        const double scale = 1 + std::fabs(jet.curvature[k]);
        rough[j] = !(bend.change(j) < kink * scale);
        agrees[j] = std::fabs(jet.curvature[k] - bend.middle(j)) <= 0.1 * bend.change(j) + 1e-7 * scale;
      }
      bool done = true;
      for (const auto& [row, j] : HessianJet::at) done = done && (row != i || rough[j] || agrees[j]);
      if (done) break;
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [row, j] = HessianJet::at[k];
      if (row != i) continue;
      ++checks.curvatures;
      checks.rough_curvatures += rough[j];
      ASSERT_TRUE(rough[j] || agrees[j]) << "curvature " << k << " is " << jet.curvature[k] << ", the difference "
                                         << bend.middle(j);
    }
  }
}

/// A point of the box where the field is not 0, looked for where its bounds are largest first.
template <class Field>
std::optional<Vec3d> find_something(const Field& field, const Box3& box, int most_steps) {
  struct Piece {
    double most;
    Box3 box;
    bool operator<(const Piece& b) const { return most < b.most; }
  };
  std::priority_queue<Piece> pieces;
  const auto add = [&](const Box3& b) {
    const double most = field.value(places_in(b)).hi;
    if (most > 0) pieces.push({most, b});
  };
  add(box);
  for (int step = 0; step < most_steps && !pieces.empty(); ++step) {
    const Box3 top = pieces.top().box;
    pieces.pop();
    if (field.value(top.center()) != 0) return top.center();
    std::size_t widest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (top.size()[i] > top.size()[widest]) widest = i;
    Box3 low = top, high = top;
    low.upper[widest] = high.lower[widest] = top.center()[widest];
    add(low);
    add(high);
  }
  return std::nullopt;
}

/// The slab of a thickness outside (or inside) a face of the support, cut to some units.
inline Box3 slab(const Box3& support, std::size_t axis, bool above, double outward) {
  Box3 s = support;
  for (std::size_t i = 0; i < 3; ++i) {
    s.lower[i] = std::max(s.lower[i], -20.0);
    s.upper[i] = std::min(s.upper[i], 20.0);
  }
  const double face = above ? support.upper[axis] : support.lower[axis];
  const double other = above ? face + outward : face - outward;
  s.lower[axis] = std::min(face, other);
  s.upper[axis] = std::max(face, other);
  return s;
}

}  // namespace marrow::test
