// Pieces add up to their skeletons, and what is called inside is inside.
#include "field/trace/sources/pieces.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "field/skeleton/shares.h"
#include "field/skeleton/skeletons.h"
#include "field/trace/shares/angle_field.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

constexpr double critical_field = 2.1;

SegmentSkeleton skeleton_of(const Piece& p) { return {p.from, p.to, p.radius_from, p.radius_to}; }

SkeletonSample field_of(const Piece& piece, const Vec3d& p, int degree) {
  return piece.is_point() ? point_field<Derivatives::ScaleInvariant>({piece.from, piece.radius}, p, degree)
                          : segment_field<Derivatives::ScaleInvariant>(skeleton_of(piece), p, degree);
}

TEST(Pieces, AddUpToTheBlend) {
  Random random(21);
  for (int n = 3; n <= 7; ++n) {
    const BlendField blend = random_scene(random, {.degree = n}, 9);
    const auto pieces = PieceCutter(n, critical_field).cut(blend);
    ASSERT_GE(pieces.size(), blend.size());
    for (const Piece& p : pieces) EXPECT_LE(p.length, 3 * p.radius * (1 + 1e-9));
    for (int i = 0; i < 300; ++i) {
      const Vec3d p = random.vector(3);
      SkeletonSample sum;
      for (const Piece& piece : pieces) sum += field_of(piece, p, n);
      const auto whole = sum_of_primitives<Derivatives::ScaleInvariant>(blend, p);
      EXPECT_LT(relative(sum.value, whole.value), 1e-11) << "n=" << n;
      EXPECT_LT(length(sum.si_gradient - whole.si_gradient), 1e-10 * n * whole.value) << "n=" << n;
    }
  }
}

TEST(Pieces, PartsAddUpToTheirPiece) {
  Random random(22);
  for (int i = 0; i < 500; ++i) {
    const int n = random.whole(3, 7);
    const PieceCutter cutter(n, critical_field);
    const BlendField blend = random_scene(random, {.degree = n}, 1);
    const auto pieces = cutter.cut(blend);
    const Piece& piece = pieces[static_cast<std::size_t>(random.whole(0, static_cast<int>(pieces.size()) - 1))];
    const double cut = random.between(0.01, 0.99);
    const Piece left = cutter.part(piece, 0, cut), right = cutter.part(piece, cut, 1);
    const Vec3d p = random.vector(3);
    EXPECT_LT(relative(field_of(left, p, n).value + field_of(right, p, n).value, field_of(piece, p, n).value), 1e-11);
    EXPECT_GE(left.mass * (1 + 1e-12), left.length * integer_power(left.radius, n - 1) / curve_normalisation(n));
    EXPECT_EQ(left.inside_distance, piece.inside_distance);
  }
}

double angle_field_of(const Piece& piece, const Vec3d& p, int degree) {
  const double f = field_of(piece, p, degree).value;
  if (piece.is_point()) return piece.factor * f;
  const double rise = segment_share(skeleton_of(piece), p, {.degree = degree}).value;
  return piece.factor * (piece.weight_at(0) * f + piece.lean * rise);
}

// Whole or in parts: the share of the range of angles times the field.
TEST(Pieces, OfAnglesAddUpToThem) {
  Random random(25);
  for (int n = 3; n <= 7; ++n) {
    const BlendField blend = with_linear_angles(random_angled_scene(random, {.degree = n}, 9), random);
    const PieceCutter cutter(n, critical_field);
    const AngleRange range = angle_range(blend).value();
    const auto pieces = angle_pieces(blend, range, cutter.cut(blend));
    EXPECT_TRUE(std::ranges::any_of(pieces, [](const Piece& p) { return p.lean != 0; }));
    for (int i = 0; i < 300; ++i) {
      const Vec3d p = random.vector(3);
      double sum = 0, of_parts = 0, at_most = 0;
      for (const Piece& piece : pieces) {
        sum += angle_field_of(piece, p, n);
        at_most += piece.mass / integer_power(distance(piece, p), piece.is_point() ? n - 1 : n);
        const double cut = random.between(0.01, 0.99);
        if (piece.is_point()) of_parts += angle_field_of(piece, p, n);
        else
          for (const Piece& part : {cutter.part(piece, 0, cut), cutter.part(piece, cut, 1)})
            of_parts += angle_field_of(part, p, n);
      }
      const BlendSample exact = evaluate(blend, p);
      const double share = (exact.alpha - range.least) / (range.most - range.least);
      EXPECT_NEAR(sum, share * exact.sum, 1e-11 * exact.sum) << "n=" << n;
      EXPECT_NEAR(of_parts, sum, 1e-11 * exact.sum) << "n=" << n;
      EXPECT_LE(sum, at_most * (1 + 1e-11)) << "n=" << n;
    }
  }
}

TEST(Pieces, MassBoundsTheFieldFromAfar) {
  Random random(23);
  for (int i = 0; i < 2000; ++i) {
    const int n = random.whole(3, 7);
    const auto pieces = PieceCutter(n, critical_field).cut(random_scene(random, {.degree = n}, 3));
    const Vec3d p = random.vector(3);
    for (const Piece& piece : pieces) {
      const double d = distance(piece, p);
      EXPECT_LE(field_of(piece, p, n).value, piece.mass / integer_power(d, piece.is_point() ? n - 1 : n) * (1 + 1e-11));
    }
  }
}

TEST(Pieces, NearerThanInsideDistanceIsInside) {
  Random random(24);
  double least = 1e300;
  for (int i = 0; i < 3000; ++i) {
    const int n = random.whole(3, 7);
    const auto pieces = PieceCutter(n, critical_field).cut(random_scene(random, {.degree = n}, 3));
    for (const Piece& piece : pieces) {
      const Vec3d on = lerp(piece.from, piece.to, std::clamp(random.between(-0.5, 1.5), 0.0, 1.0));
      const Vec3d p = on + random_direction(random) * (piece.inside_distance * random.between(0.5, 1));
      if (distance(piece, p) == 0) continue;
      const double f = field_of(piece, p, n).value;
      EXPECT_GT(f, critical_field) << "n=" << n;
      least = std::min(least, f);
    }
  }
  std::cout << "  least field within inside_distance: " << least << " for " << critical_field << '\n';
  EXPECT_LT(least, 1.3 * critical_field) << "the distance could be larger";
}

TEST(Pieces, OfAnyLengthHaveAnInsideOrNone) {
  for (const int n : {3, 8, 20})
    for (double length = 1e-25; length < 1e8; length *= 10) {
      BlendField blend;
      blend.degree = n;
      blend.segments.skeletons.push_back({{0, 0, 0}, {length, 0, 0}, 1, 1});
      // Long ones are of many pieces, all alike.
      if (length > 1e5) blend.segments.skeletons[0] = {{0, 0, 0}, {length, 0, 0}, length, length};
      const Piece piece = PieceCutter(n, critical_field).cut(blend).front();
      EXPECT_GE(piece.inside_distance, 0);
      EXPECT_LT(piece.inside_distance, piece.radius);
      if (piece.inside_distance < 1e-12 * piece.radius) continue;
      const Vec3d p{-piece.inside_distance, 0, 0};
      EXPECT_GT(field_of(piece, p, n).value, critical_field) << "length " << length << ", degree " << n;
    }
}

}  // namespace
}  // namespace marrow::test
