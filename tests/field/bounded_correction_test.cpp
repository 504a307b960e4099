// Laws of the correction operator of the Cauchy and the compact kernel.
#include "field/blend/correction/bounded_correction.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "field/blend/angle/contact.h"
#include "field/blend/blend_field.h"
#include "field/blend/bounds/correction/correction_bounds.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;
using test::relative;

constexpr double half_pi = std::numbers::pi / 2;
constexpr auto second = Derivatives::Second;

Kernel random_kernel(Random& random, int i) {
  const int n = random.whole(3, 12);
  return i % 2 == 0 ? Kernel{KernelFamily::Cauchy, n, random.between(1 / std::sqrt(n), 3)}
                    : Kernel{KernelFamily::Compact, n, random.between(1.1, std::sqrt(n))};
}
Correction random_correction(const Kernel& kernel, int i, double alpha) {
  return Correction(kernel, alpha, i % 4 < 2, i % 8 < 4 ? Projection::Paper : Projection::Exact);
}

struct Place {
  double f, G;
};
Place random_place(Random& random, const Kernel& kernel) {
  const BoundedCurve curve(kernel);
  const double f = std::min(curve.largest_field(), 3.0) * random.between(0.01, 1.2);
  return {f, curve.at(f) * random.between(0, 1.4)};
}

TEST(BoundedCurve, IsTheCurveOfALonePoint) {
  Random random(201);
  for (int i = 0; i < 400; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const BoundedCurve curve(kernel);
    const SkeletonSample s = point_field<second>({{0, 0, 0}, 1}, {random.between(0, 2), 0, 0}, kernel);
    if (s.value == 0) continue;
    EXPECT_NEAR(curve.alone_at(s.value), length(s.si_gradient), 1e-11 * curve.top());
    if (s.value < curve.top_field()) {
      EXPECT_NEAR(curve.at(s.value), length(s.si_gradient), 1e-12 * curve.top());
    } else {
      EXPECT_EQ(curve.at(s.value), curve.top());
    }
  }
}

// The operator brings whole volumes to the top: where that would be 1 but for rounding, they are outside for certain.
TEST(BoundedCurve, LevelsOffOutsideWhereItsTopIsTheSurface) {
  Random random(214);
  for (int i = 0; i < 400; ++i) {
    const int n = random.whole(3, 20);
    const Kernel kernel =
        i % 2 == 0 ? Kernel{KernelFamily::Cauchy, n, 1 / std::sqrt(n)} : Kernel{KernelFamily::Compact, n, std::sqrt(n)};
    const BoundedCurve curve(kernel);
    EXPECT_LT(curve.top_field(), 1 - 5e-11);
    EXPECT_GT(curve.top_field(), 1 - 2e-10);
    const double alpha = random.between(0, half_pi);
    const Correction c = random_correction(kernel, i, alpha);
    const Interval f{0, random.between(0.1, 0.99999)}, G{0, curve.top() * random.between(1, 2)};
    EXPECT_LT(correction_bounds(c, f, G).hi, 1) << i;
    // what lone skeletons have at the surface stays
    EXPECT_NEAR(Correction(kernel, alpha, false, c.projection()).value(1, curve.alone_at(1)), 1, 1e-9) << i;
  }
}

TEST(BoundedCurve, HasItsInverseAndItsSlope) {
  Random random(202);
  for (int i = 0; i < 2000; ++i) {
    const BoundedCurve curve(random_kernel(random, i));
    const double f = curve.top_field() * (i % 3 == 0 ? exp(-random.between(1, 40)) : random.between(0.01, 0.98));
    EXPECT_LE(relative(curve.inverse(curve.at(f)), f), 1e-11) << f / curve.top_field();
    const double h = 1e-5 * f;
    EXPECT_NEAR((curve.at(f + h) - curve.at(f - h)) / (2 * h), curve.slope(f), 1e-6 * curve.at(f) / f);
    const double angle = random.between(0, half_pi), c = cos(angle), s = sin(angle);
    EXPECT_LE(relative(curve.on_line(c, s, curve.at(f) * c + f * s), f), 1e-11) << f / curve.top_field();
  }
  const BoundedCurve curve({KernelFamily::Cauchy, 4, 1});
  EXPECT_NEAR(curve.top_field(), 2.0238577, 1e-7);  // at s x = 1 / sqrt(n)
  EXPECT_NEAR(curve.top(), 2.4286292, 1e-7);
}

TEST(BoundedCorrection, PartialsAreTheDerivativesInEveryBranch) {
  Random random(203);
  int in_branch = 0, checked = 0, below = 0, beyond = 0;
  for (int i = 0; i < 12000; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const double alpha = random.between(0.02, 1.55);
    const Correction c = random_correction(kernel, i, alpha);
    const auto [f, G] = random_place(random, kernel);
    const double hf = 1e-5 * f, hG = 1e-5 * G, ha = 1e-5;
    const auto at = c.partials(f, G);
    EXPECT_EQ(at.value, c.value(f, G));
    const bool branch = c.in_cavity_branch(f, G);
    double jump = 0;
    for (const auto& [x, y] :
         {Place{f - 2 * hf, G}, Place{f + 2 * hf, G}, Place{f, G - 2 * hG}, Place{f, G + 2 * hG}}) {
      if (c.in_cavity_branch(x, y) != branch) jump = 1;
      jump = std::max({jump, relative(c.partials(x, y).df, at.df), relative(c.partials(x, y).dG, at.dG)});
    }
    if (jump > 1e-2) continue;
    const double df = (c.value(f + hf, G) - c.value(f - hf, G)) / (2 * hf);
    const double dG = (c.value(f, G + hG) - c.value(f, G - hG)) / (2 * hG);
    const double dalpha =
        (random_correction(kernel, i, alpha + ha).value(f, G) - random_correction(kernel, i, alpha - ha).value(f, G)) /
        (2 * ha);
    const double scale = std::max({1.0, at.df, at.dG * G / f});
    EXPECT_NEAR(at.df, df, 3e-5 * scale) << i << " f " << f << " G " << G << " branch " << branch;
    EXPECT_NEAR(at.dG * G / f, dG * G / f, 3e-5 * scale) << i << " f " << f << " G " << G << " branch " << branch;
    EXPECT_NEAR(at.dalpha / f, dalpha / f, 1e-4) << i << " f " << f << " G " << G << " branch " << branch;
    ++checked;
    in_branch += branch;
    below += G < BoundedCurve(kernel).at(f);
    beyond += f > BoundedCurve(kernel).top_field();
  }
  std::cout << "  " << checked << " places, " << in_branch << " in the cavity branch, " << below << " below, " << beyond
            << " beyond the top\n";
  EXPECT_GT(checked, 6000);
  EXPECT_GT(in_branch, 1000);
  EXPECT_GT(below, 3000);
  EXPECT_GT(beyond, 500);
}

// Over the whole quarter plane, as far beyond the curve as sums can be.
TEST(BoundedCorrection, IsIsotoneAndBounded) {
  Random random(204);
  for (int i = 0; i < 30000; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const double alpha = i % 16 == 0 ? 0 : random.between(0, half_pi);
    const Correction c = random_correction(kernel, i, alpha);
    const BoundedCurve curve(kernel);
    const double f = curve.largest_field() * random.between(0, 3), G = curve.top() * random.between(0, 2);
    const double here = c.value(f, G), slack = 1e-8 * (here + curve.top_field());
    const double more = exp(random.between(-12, 0));
    EXPECT_LE(here, c.value(f * (1 + more), G) + slack) << i << " f " << f << " G " << G;
    EXPECT_LE(here, c.value(f, G + curve.top() * more) + slack) << i << " f " << f << " G " << G;
    if (c.in_cavity_branch(f, G)) continue;
    EXPECT_LE(here, std::max(f, curve.top_field()) * (1 + 1e-12));
  }
}

TEST(BoundedCorrection, IsContinuous) {
  Random random(205);
  for (int i = 0; i < 3000; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const Correction c = random_correction(kernel, i, random.between(0.05, half_pi));
    const BoundedCurve curve(kernel);
    double f0 = curve.largest_field() * random.between(0, 2.5), f1 = curve.largest_field() * random.between(0, 2.5);
    double G0 = curve.top() * random.between(0, 2), G1 = curve.top() * random.between(0, 2);
    // follow the half with the larger change of value: at a jump it does not become small
    for (int step = 0; step < 44; ++step) {
      const double f = (f0 + f1) / 2, G = (G0 + G1) / 2, middle = c.value(f, G);
      const bool first = std::fabs(middle - c.value(f0, G0)) > std::fabs(middle - c.value(f1, G1));
      (first ? f1 : f0) = f;
      (first ? G1 : G0) = G;
    }
    EXPECT_NEAR(c.value(f0, G0), c.value(f1, G1), 3e-6 * curve.top_field()) << i << " f " << f0 << " G " << G0;
  }
}

// With cavity the last tenth below the top of compact kernels is taken for a pair, for small alpha.
TEST(BoundedCorrection, LeavesALoneSkeletonAsItIsUpToTheTop) {
  Random random(206);
  for (int i = 0; i < 4000; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const BoundedCurve curve(kernel);
    const double alpha = random.between(0, half_pi);
    const double f =
        curve.top_field() * random.between(1e-3, i % 4 < 2 && kernel.family == KernelFamily::Compact ? 0.85 : 0.99);
    EXPECT_LE(relative(random_correction(kernel, i, alpha).value(f, curve.at(f)), f), 1e-10)
        << "n " << kernel.degree << " shape " << kernel.shape << " alpha " << alpha << " f " << f;
  }
}

TEST(BoundedCorrection, JoinsEqualSkeletonsExactlyWhenTheyTouch) {
  int exact = 0;
  for (int n = 3; n <= 20; ++n)
    for (const Kernel& kernel : {Kernel{KernelFamily::Cauchy, n, n == 3 ? 1.1 : 1}, Kernel{KernelFamily::Cauchy, n, 2},
                                 Kernel{KernelFamily::Compact, n, 1.3}, Kernel{KernelFamily::Compact, n, 1.6}})
      for (const Projection projection : {Projection::Paper, Projection::Exact}) {
        ASSERT_TRUE(contact_angle(kernel, true, projection).is_exact) << n << ' ' << kernel.shape;
        const double alpha = contact_alpha(kernel, true, projection);
        const auto between = [&](double distance) {
          BlendField blend;
          blend.kernel = kernel.family;
          blend.kernel_shape = kernel.shape;
          blend.degree = n;
          blend.alpha = alpha;
          blend.projection = projection;
          blend.points.add({{0, 0, 0}, 0.7}, {});
          blend.points.add({{distance, 0, 0}, 0.7}, {});
          return corrected_value(blend, {distance / 2, 0, 0});
        };
        EXPECT_NEAR(between(1.4), 1, 1e-11) << n;
        EXPECT_GT(between(1.39), 1) << n;
        EXPECT_LT(between(1.41), 1) << n;
        EXPECT_TRUE(Correction(kernel, alpha, true, projection).bounded()->solid_alone()) << n << ' ' << kernel.shape;
        ++exact;
      }
  EXPECT_EQ(exact, 144);
}

TEST(BoundedCorrection, GradientsOfBlendsAreTheDerivativesOfTheirCorrectedFields) {
  Random random(208);
  int checked = 0, in_branch = 0;
  for (int i = 0; i < 6000; ++i) {
    Kernel kernel = random_kernel(random, i);
    // the third derivative of low compact kernels is not bounded where their support begins
    if (kernel.family == KernelFamily::Compact) kernel.degree = std::max(kernel.degree, 8);
    BlendField blend;
    blend.kernel = kernel.family;
    blend.kernel_shape = kernel.shape;
    blend.degree = kernel.degree;
    blend.alpha = random.between(0.1, 1.55);
    blend.projection = i % 4 < 2 ? Projection::Paper : Projection::Exact;
    for (int k = 0; k < 3; ++k) {
      blend.points.add(random.point(), {});
      blend.segments.add(random.segment(), {});
    }
    const Vec3d p = random.vector(2);
    const BlendSample s = evaluate(blend, p);
    EXPECT_EQ(s.corrected, corrected_value(blend, p));
    if (s.corrected < 0.2 || s.corrected > 4) continue;
    const double step = 1e-4;
    double jump = 0;
    test::for_each_beside(p, 3 * step, [&](const Vec3d& q) {
      jump = std::max(jump, test::relative(evaluate(blend, q).corrected_gradient, s.corrected_gradient));
    });
    if (jump > 5e-3) continue;
    const auto value = [&](const Vec3d& q) { return corrected_value(blend, q); };
    EXPECT_LE(relative(test::numeric_gradient(value, p, step), s.corrected_gradient), 1e-5) << i;
    ++checked;
    in_branch += correction_of(blend).in_cavity_branch(s.sum, s.si_norm);
  }
  std::cout << "  " << checked << " places, " << in_branch << " in the cavity branch\n";
  EXPECT_GT(checked, 1000);
  EXPECT_GT(in_branch, 30);
}

// Outward from the middle of two equal skeletons the exact projection never rises.
TEST(BoundedCorrection, LeavesNoCavityBetweenEqualSkeletonsWithExactProjection) {
  Random random(207);
  double worst_paper = 0;
  for (int i = 0; i < 200; ++i) {
    const Kernel kernel = random_kernel(random, i);
    BlendField blend;
    blend.kernel = kernel.family;
    blend.kernel_shape = kernel.shape;
    blend.degree = kernel.degree;
    blend.alpha = random.between(0, 1.55);
    const double a = random.between(0.2, 1.4);
    blend.points.add({{-a, 0, 0}, 1}, {});
    blend.points.add({{a, 0, 0}, 1}, {});
    for (const Projection projection : {Projection::Exact, Projection::Paper}) {
      blend.projection = projection;
      double least = corrected_value(blend, {0, 0, 0});
      for (int k = 1; k <= 300; ++k) {
        const double value = corrected_value(blend, {0, 0.01 * k, 0});
        if (projection == Projection::Exact) {
          EXPECT_LE(value, least * (1 + 1e-9) + 1e-12) << i << " height " << 0.01 * k;
        } else if (least > 0.05) {
          worst_paper = std::max(worst_paper, value / least - 1);
        }
        least = std::min(least, value);
      }
    }
  }
  std::cout << "  worst rise with the paper's projection " << worst_paper << '\n';
  EXPECT_LE(worst_paper, 0.05);
}

// With cavity C may fall, then rise with the angle: the ends of a range of angles do not bound it.
TEST(BoundedCorrection, IsBoundedOverRangesOfAngles) {
  Random random(57);
  int outside_ends = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Kernel kernel{KernelFamily::Compact, random.whole(3, 8), random.between(1.2, 4)};
    const Projection projection = i % 2 == 0 ? Projection::Paper : Projection::Exact;
    const auto with = [&](double alpha) { return BoundedCorrection(kernel, alpha, true, projection); };
    const double a = random.between(0, 1.57), b = random.between(0, 1.57);
    const BoundedCorrection least = with(std::min(a, b)), most = with(std::max(a, b));
    const double top = least.curve().top_field(), f = random.between(0.1, 2.5) * top;
    const double G = random.between(0, 1.5) * least.curve().at(std::min(f, top));
    const Interval f_range{f, f * random.between(1, 1.1)}, G_range{G, G * random.between(1, 1.1)};
    const Interval bounds = correction_bounds_between(least, most, f_range, G_range);
    const double share = random.between(0, 1), angle = (1 - share) * std::min(a, b) + share * std::max(a, b);
    const double low = with(angle).value(f_range.lo, G_range.lo), high = with(angle).value(f_range.hi, G_range.hi);
    EXPECT_TRUE(bounds.lo <= low && high <= bounds.hi)
        << low << " .. " << high << " in " << bounds.lo << " .. " << bounds.hi;
    outside_ends +=
        low < std::min(least.value(f_range.lo, G_range.lo), most.value(f_range.lo, G_range.lo)) * (1 - 1e-9);
  }
  EXPECT_GT(outside_ends, 0);
}

}  // namespace
}  // namespace marrow
