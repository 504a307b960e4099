// Laws of subdivision curves: their limits, what stays fixed, and what they commute with.
#include "field/skeleton/subdivision_curve.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "field/program/field_program.h"
#include "tests/field/distance_to.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;
using test::relative;

CurveSkeleton random_curve(Random& random, Subdivision subdivision, int levels) {
  CurveSkeleton curve;
  curve.subdivision = subdivision;
  curve.levels = levels;
  const int count = random.whole(2, 8);
  for (int i = 0; i < count; ++i) {
    curve.points.push_back(random.vector(1));
    curve.radii.push_back(random.between(0.1, 0.5));
  }
  return curve;
}

double arc_length(const PolylineSkeleton& line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) sum += length(line.points[i] - line.points[i - 1]);
  return sum;
}

double distance_to(const PolylineSkeleton& line, const Vec3d& p) {
  double least = 1e300;
  for (std::size_t i = 1; i < line.points.size(); ++i)
    least = std::min(least, test::distance_to(SegmentSkeleton{line.points[i - 1], line.points[i], 1, 1}, p));
  return least;
}

// Uniform B-splines over the control points i, i+1, ... at t in [0, 1].
Vec3d quadratic_spline(const std::vector<Vec3d>& c, std::size_t i, double t) {
  return (c[i] * ((1 - t) * (1 - t)) + c[i + 1] * (1 + 2 * t - 2 * t * t) + c[i + 2] * (t * t)) * 0.5;
}
Vec3d cubic_spline(const std::vector<Vec3d>& c, std::size_t i, double t) {
  const double s = 1 - t;
  return (c[i] * (s * s * s) + c[i + 1] * (3 * t * t * t - 6 * t * t + 4) + c[i + 2] * (3 * s * s * s - 6 * s * s + 4) +
          c[i + 3] * (t * t * t)) *
         (1.0 / 6);
}

TEST(SubdivisionCurve, TendsToTheUniformBSpline) {
  Random random(61);
  for (int i = 0; i < 20; ++i) {
    const auto quadratic = random_curve(random, Subdivision::Chaikin, 8);
    const PolylineSkeleton line = subdivide(quadratic);
    // Spans next to an end differ: there the joint sticks.
    for (std::size_t k = 1; k + 3 < quadratic.points.size(); ++k)
      for (const double t : {0.0, 0.25, 0.5, 0.8})
        EXPECT_LE(distance_to(line, quadratic_spline(quadratic.points, k, t)), 1e-4);
    auto cubic = random_curve(random, Subdivision::Cubic, 8);
    const PolylineSkeleton smooth = subdivide(cubic);
    // A sticking end is a joint with a mirrored neighbour.
    std::vector<Vec3d> c = cubic.points;
    c.insert(c.begin(), c[0] * 2 - c[1]);
    c.push_back(c[c.size() - 1] * 2 - c[c.size() - 2]);
    for (std::size_t k = 0; k + 3 < c.size(); ++k)
      for (const double t : {0.0, 0.3, 0.7}) EXPECT_LE(distance_to(smooth, cubic_spline(c, k, t)), 1e-4);
  }
}

TEST(SubdivisionCurve, PassesThroughEndsAndStickingJoints) {
  Random random(62);
  for (const Subdivision subdivision : {Subdivision::Chaikin, Subdivision::Cubic})
    for (int i = 0; i < 20; ++i) {
      CurveSkeleton curve = random_curve(random, subdivision, i % 6);
      curve.sticking = {random.whole(0, static_cast<int>(curve.points.size()) - 1)};
      const PolylineSkeleton line = subdivide(curve);
      EXPECT_EQ(line.points.front(), curve.points.front());
      EXPECT_EQ(line.points.back(), curve.points.back());
      const auto joint = static_cast<std::size_t>(curve.sticking[0]);
      const auto at = std::find(line.points.begin(), line.points.end(), curve.points[joint]);
      ASSERT_NE(at, line.points.end());
      EXPECT_EQ(line.radii[static_cast<std::size_t>(at - line.points.begin())], curve.radii[joint]);
    }
}

TEST(SubdivisionCurve, WithEveryJointStickingIsItsPolyline) {
  Random random(63);
  CurveSkeleton curve = random_curve(random, Subdivision::Chaikin, 5);
  for (std::size_t i = 0; i < curve.points.size(); ++i) curve.sticking.push_back(static_cast<int>(i));
  EXPECT_EQ(subdivide(curve), (PolylineSkeleton{curve.points, curve.radii}));
  curve.subdivision = Subdivision::Cubic;
  for (const Vec3d& p : subdivide(curve).points) EXPECT_LE(distance_to({curve.points, curve.radii}, p), 1e-15);
}

// Cutting corners shortens; what is left to cut falls by 4 from level to level (by less next to a chaikin end,
// where the first edge keeps three quarters).
TEST(SubdivisionCurve, LengthFallsAndConverges) {
  Random random(64);
  for (const Subdivision subdivision : {Subdivision::Chaikin, Subdivision::Cubic})
    for (int i = 0; i < 10; ++i) {
      CurveSkeleton curve = random_curve(random, subdivision, 0);
      std::vector<double> lengths;
      for (; curve.levels <= 8; ++curve.levels) lengths.push_back(arc_length(subdivide(curve)));
      for (std::size_t k = 1; k < lengths.size(); ++k) EXPECT_LE(lengths[k], lengths[k - 1] * (1 + 1e-14));
      const double before = lengths[5] - lengths[6], after = lengths[6] - lengths[7];
      EXPECT_LE(after, 0.5 * before + 1e-12);
      EXPECT_LE(after, 1e-3);
    }
}

TEST(SubdivisionCurve, CommutesWithMapsAndReversalAndKeepsRadiiInRange) {
  Random random(65);
  const Affine map =
      Affine::translate({1, -2, 3}) * Affine::rotate(normalize({1, 2, 3}), 0.7) * Affine::scale({2, 1, 3});
  for (const Subdivision subdivision : {Subdivision::Chaikin, Subdivision::Cubic})
    for (int i = 0; i < 20; ++i) {
      const CurveSkeleton curve = random_curve(random, subdivision, 4);
      CurveSkeleton mapped = curve, reversed = curve;
      for (Vec3d& p : mapped.points) p = map.point(p);
      std::reverse(reversed.points.begin(), reversed.points.end());
      std::reverse(reversed.radii.begin(), reversed.radii.end());
      const PolylineSkeleton a = subdivide(curve), b = subdivide(mapped), c = subdivide(reversed);
      const auto [low, high] = std::minmax_element(curve.radii.begin(), curve.radii.end());
      ASSERT_EQ(a.points.size(), b.points.size());
      for (std::size_t k = 0; k < a.points.size(); ++k) {
        EXPECT_LE(length(map.point(a.points[k]) - b.points[k]), 1e-13);
        EXPECT_LE(length(a.points[k] - c.points[a.points.size() - 1 - k]), 1e-14);
        EXPECT_TRUE(a.radii[k] >= *low * (1 - 1e-15) && a.radii[k] <= *high * (1 + 1e-15));
      }
    }
}

TEST(SubdivisionCurve, CompilesToTheFieldOfItsPolyline) {
  Random random(66);
  const CurveSkeleton curve = random_curve(random, Subdivision::Cubic, 3);
  const auto program_of = [](auto skeleton) {
    FieldDescription description;
    Primitive primitive;
    primitive.skeleton = std::move(skeleton);
    description.root = description.add({.what = primitive, .where = {}});
    return *compile(description);
  };
  const FieldProgram smooth = program_of(curve), line = program_of(subdivide(curve));
  EXPECT_EQ(smooth.parts()[0].blend.segments.size(), (curve.points.size() - 1) * 8);
  for (int i = 0; i < 20; ++i) {
    const Vec3d p = random.vector(2);
    EXPECT_EQ(value(smooth, p), value(line, p));
  }
}

TEST(SubdivisionCurve, RefusesWhatItCannotRefine) {
  const auto errors_of = [](CurveSkeleton curve) {
    FieldDescription description;
    Primitive primitive;
    primitive.skeleton = std::move(curve);
    description.root = description.add({.what = primitive, .where = {}});
    const auto result = compile(description);
    return result ? Diagnostics{} : result.why();
  };
  CurveSkeleton good;
  good.points = {{0, 0, 0}, {1, 0, 0}};
  good.radii = {1, 1};
  EXPECT_TRUE(errors_of(good).empty());
  CurveSkeleton deep = good, short_of_points = good, far = good;
  deep.levels = 13;
  short_of_points.points.pop_back();
  far.sticking = {2};
  EXPECT_EQ(errors_of(deep).size(), 1u);
  EXPECT_EQ(errors_of(short_of_points).size(), 2u);
  EXPECT_EQ(errors_of(far).size(), 1u);
}

}  // namespace
}  // namespace marrow
