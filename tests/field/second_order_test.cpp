// Second derivatives of every skeleton and of every corrected field, against differences of the first ones, which have
// code of their own.
#include "field/skeleton/second_order.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/curvature.h"
#include "field/blend/gather.h"
#include "field/number/quotients.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"
#include "tests/field/varied_blend.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::relative;
using test::varied_blend;

constexpr auto second = Derivatives::Second;

double magnitude(const Matrix3& m) { return length(m.rows[0]) + length(m.rows[1]) + length(m.rows[2]); }

// Rows of second derivatives by differences of what gives the first ones, and how uncertain they are.
struct Differences {
  Matrix3 rows;
  double change = 0;
};
template <class Gradient>
Differences differences_of(const Gradient& gradient, const Vec3d& p, double step) {
  const auto with = [&](double h) {
    Matrix3 m;
    for (std::size_t k = 0; k < 3; ++k)
      m.rows[k] = numeric_gradient([&](const Vec3d& q) { return gradient(q)[k]; }, p, h);
    return m;
  };
  const Matrix3 wide = with(2 * step), narrow = with(step);
  return {narrow, magnitude(wide + narrow * -1.0)};
}

struct Subject {
  std::string name;
  std::function<SkeletonSample(const Vec3d&)> plain;
  std::function<SecondOrderSample(const Vec3d&)> jets;
  double tolerance = 1e-7;
};

template <class Skeleton>
Subject integral(const std::string& name, const Skeleton& s, const Kernel& kernel) {
  const auto plain = [=](const Vec3d& p) -> SkeletonSample {
    if constexpr (std::same_as<Skeleton, PointSkeleton>)
      return kernel.family == KernelFamily::Inverse ? point_field<second>(s, p, kernel.degree)
                                                    : point_field<second>(s, p, kernel);
    else if constexpr (std::same_as<Skeleton, SegmentSkeleton>)
      return kernel.family == KernelFamily::Inverse ? segment_field<second>(s, p, kernel.degree)
                                                    : segment_field<second>(s, p, kernel);
    else if constexpr (std::same_as<Skeleton, TriangleSkeleton>)
      return kernel.family == KernelFamily::Inverse ? triangle_field<second>(s, p, kernel.degree)
                                                    : triangle_field<second>(s, p, kernel);
    else
      return kernel.family == KernelFamily::Inverse ? arc_field<second>(s, p, kernel.degree)
                                                    : arc_field<second>(s, p, kernel);
  };
  const bool differs = kernel.family == KernelFamily::Compact &&
                       (std::same_as<Skeleton, ArcSkeleton> || std::same_as<Skeleton, TriangleSkeleton>);
  return {name, plain, [=](const Vec3d& p) { return second_order(s, p, kernel); }, differs ? 1e-4 : 1e-7};
}
template <class Skeleton>
Subject by_distance(const std::string& name, const Skeleton& s, const Kernel& kernel) {
  return {"distance " + name, [=](const Vec3d& p) { return distance_field<second>(s, p, kernel); },
          [=](const Vec3d& p) { return second_order_by_distance(s, p, kernel); }};
}

Kernel random_kernel(Random& random, int family) {
  const int degree = random.whole(3, 9);
  if (family == 1) return {KernelFamily::Cauchy, degree, random.between(0.7, 2)};
  if (family == 2) return {KernelFamily::Compact, degree, random.between(1.5, 3)};
  return {KernelFamily::Inverse, degree, 1};
}

std::vector<Subject> random_subjects(Random& random, int round) {
  const int family = round % 3;
  const Kernel kernel = random_kernel(random, family);
  const SegmentSkeleton segment = random.segment();
  const ArcSkeleton arc = random.arc();
  const TriangleSkeleton triangle = random.triangle();
  std::vector<Subject> all{integral("point", random.point(), kernel),
                           integral("segment", segment, kernel),
                           integral("arc", arc, kernel),
                           by_distance("segment", segment, kernel),
                           by_distance("triangle", triangle, kernel),
                           by_distance("arc", arc, kernel)};
  if (family != 2 || round % 5 == 0) all.push_back(integral("triangle", triangle, kernel));
  if (family == 0)
    all.push_back({"cani_hornus", [=](const Vec3d& p) { return cani_hornus_field<second>(segment, p); },
                   [=](const Vec3d& p) { return second_order_of_cani_hornus(segment, p); }});
  return all;
}

TEST(SecondOrder, OfEverySkeletonAndKernel) {
  Random random(701);
  int checked = 0, rough = 0;
  for (int round = 0; round < 120; ++round)
    for (const Subject& subject : random_subjects(random, round)) {
      SCOPED_TRACE(subject.name + " in round " + std::to_string(round));
      const Vec3d p = random.vector(2);
      const SkeletonSample s = subject.plain(p);
      const SecondOrderSample jets = subject.jets(p);
      if (!(s.value > 1e-6) || s.value > 20) continue;
      EXPECT_LE(relative(s.value, jets.field.value), 1e-11);
      EXPECT_LE(relative(s.gradient, gradient_of(jets.field)), 1e-10);
      const double size = length(s.si_gradient), jacobian_size = magnitude(s.si_jacobian);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(s.si_gradient[c], jets.si[c].value, 1e-10 * size);
        EXPECT_LE(length(s.si_jacobian.rows[c] - gradient_of(jets.si[c])), 1e-9 * jacobian_size);
      }
      const auto agrees = [&](const Differences& d, const HessianJet& jet) {
        const Matrix3 exact = hessian_of(jet);
        const double scale = magnitude(exact) + 1e-3 * (size + jacobian_size);
        ++checked;
        if (!(d.change < 1e-3 * scale)) {
          ++rough;
          return;
        }
        EXPECT_LE(magnitude(d.rows + exact * -1.0), d.change + subject.tolerance * scale);
      };
      agrees(differences_of([&](const Vec3d& q) { return subject.plain(q).gradient; }, p, 1e-4), jets.field);
      for (std::size_t c = 0; c < 3; ++c)
        agrees(differences_of([&](const Vec3d& q) { return subject.plain(q).si_jacobian.rows[c]; }, p, 1e-4),
               jets.si[c]);
    }
  std::cout << "  " << checked << " Hessians, " << rough << " at kinks\n";
  EXPECT_GT(checked, 2000);
  EXPECT_LT(rough, checked / 5);
}

// In every branch: below and above the curve, in the cavity, under the guard; near critical points too.
TEST(SecondOrder, OfCorrectedFields) {
  Random random(703);
  int checked = 0, rough = 0, in_cavity = 0;
  double worst = 0;
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const BlendField blend = varied_blend(random, round);
    const Vec3d p = round % 4 == 3 ? random.vector(0.3) : random.vector(2);
    const BlendSample s = evaluate(blend, p);
    if (!(s.corrected > 1e-4) || s.corrected > 20) continue;
    const HessianJet jet = second_order_corrected(blend, p);
    EXPECT_LE(relative(s.corrected, jet.value), 1e-11);
    const double size = length(s.corrected_gradient);
    EXPECT_LE(length(s.corrected_gradient - gradient_of(jet)), 1e-9 * (size + s.corrected));
    const Differences d =
        differences_of([&](const Vec3d& q) { return evaluate(blend, q).corrected_gradient; }, p, 1e-4);
    const Matrix3 exact = hessian_of(jet);
    const double scale = magnitude(exact) + 1e-2 * (size + s.corrected);
    ++checked;
    in_cavity += correction_of(blend).in_cavity_branch(s.sum, s.si_norm);
    if (!(d.change < 1e-3 * scale)) {
      ++rough;
      continue;
    }
    const double error = magnitude(d.rows + exact * -1.0) / scale;
    worst = std::max(worst, error);
    const bool by_differences = blend.kernel == KernelFamily::Compact && !blend.arcs.empty();
    EXPECT_LE(error, 2 * d.change / scale + (by_differences ? 1e-4 : 1e-6));
  }
  std::cout << "  " << checked << " Hessians, " << in_cavity << " in the cavity branch, " << rough
            << " at kinks; worst relative difference " << worst << '\n';
  EXPECT_GT(checked, 600);
  EXPECT_GT(in_cavity, 60);
  EXPECT_LT(rough, checked / 8);
}

// A lone infinite skeleton lies on the curve, where the chord is the curve's tangent: C = f, whatever the angle.
TEST(SecondOrder, OnTheReferenceCurveTheCorrectionChangesNothing) {
  Random random(704);
  for (int round = 0; round < 300; ++round) {
    BlendField ball;
    ball.degree = random.whole(3, 9);
    ball.alpha = random.between(0, 1.5);
    ball.cavity = round % 2 == 0;
    ball.projection = round % 4 < 2 ? Projection::Paper : Projection::Exact;
    ball.points.add({{0, 0, 0}, random.between(0.2, 2)}, {});
    const Vec3d p = random.vector(3);
    const HessianJet jet = second_order_corrected(ball, p);
    const Matrix3 plain = sum_hessian(ball, p);
    EXPECT_LE(magnitude(hessian_of(jet) + plain * -1.0), 1e-11 * magnitude(plain)) << round;
  }
}

TEST(Quotients, AreSmoothAcrossTheirSeries) {
  for (const double x :
       {-3.0, -1.0 - 1e-12, -1.0 + 1e-12, -0.2, -1e-9, 0.0, 1e-9, 0.3, 1.0 - 1e-12, 1.0 + 1e-12, 4.0}) {
    const auto check = [&](const auto& quotient, long double exact, double least) {
      if (!(x > least)) return;
      const HessianJet at = quotient(HessianJet::variable(x, 0));
      EXPECT_NEAR(at.value, static_cast<double>(exact), 1e-15 * (1 + std::fabs(at.value))) << x;
      constexpr double h = 1e-4;
      const HessianJet ahead = quotient(HessianJet::variable(x + h, 0)),
                       behind = quotient(HessianJet::variable(x - h, 0));
      EXPECT_NEAR(at.slope[0], (ahead.value - behind.value) / (2 * h), 1e-8 * (1 + std::fabs(at.slope[0]))) << x;
      EXPECT_NEAR(at.curvature[0], (ahead.slope[0] - behind.slope[0]) / (2 * h), 1e-7 * (1 + at.curvature[0])) << x;
    };
    const long double y = x;
    check([](const HessianJet& v) { return exp_quotient(v); }, x == 0 ? 1 : std::expm1(y) / y, -10);
    check([](const HessianJet& v) { return log_quotient(v); }, x == 0 ? 1 : std::log1p(y) / y, -0.9);
  }
}

}  // namespace
}  // namespace marrow
