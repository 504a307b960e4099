// In a ball a strand by distance is what is left of it: the same largest field, from fewer segments.
#include "field/blend/bounds/sum/distances_in_reach.h"

#include <algorithm>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "field/blend/primitive_visit.h"
#include "field/math/elementary.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

// Polylines that share the radius at joints, or jump there; of one radius, tapered, or steep down to a point.
PrimitiveList<SegmentSkeleton> random_strands(Random& random, int count) {
  PrimitiveList<SegmentSkeleton> list;
  for (int strand = 0; strand < count; ++strand) {
    Vec3d at = random.vector(2);
    const double step = pow(10.0, random.between(-1.5, 0)), thick = pow(10.0, random.between(-2, -0.5));
    const int kind = random.whole(0, 3);
    double radius = thick;
    for (int i = random.whole(1, 12); i > 0; --i) {
      const Vec3d next = at + random.vector(step);
      const double begin = kind == 3 ? thick * random.between(0.5, 1.5) : radius;
      radius = kind == 0 ? thick : thick * (kind == 2 ? pow(10.0, random.between(-3, 0.5)) : random.between(0.8, 1.2));
      list.skeletons.push_back({at, next, begin, radius});
      list.strands.push_back(static_cast<std::uint32_t>(strand));
      at = next;
    }
  }
  return list;
}

double largest(std::span<const SegmentSkeleton> strand, const Vec3d& p, const Kernel& kernel) {
  double f = 0;
  for (const SegmentSkeleton& s : strand)
    f = std::max(f, distance_field<Derivatives::ScaleInvariant>(s, p, kernel).value);
  return f;
}

// By strands, which are not told apart: both sums have the same terms.
double sum_of_strands(const PrimitiveList<SegmentSkeleton>& list, const Vec3d& p, const Kernel& kernel) {
  double sum = 0;
  for_each_strand(list, [&](std::size_t, auto strand) { sum += largest(strand, p, kernel); });
  return sum;
}

Kernel random_kernel(Random& random, int round) {
  if (round % 4 == 3) return {KernelFamily::Compact, random.whole(3, 8), random.between(1.2, 3)};
  if (round % 4 == 2) return {KernelFamily::Cauchy, random.whole(3, 8), random.between(0.5, 2)};
  return {KernelFamily::Inverse, random.whole(3, 8), 1};
}

TEST(DistancesInReach, HaveTheSameFieldInTheBall) {
  Random random(20261128);
  std::size_t all = 0, left = 0, ends = 0;
  double worst = 0;
  for (int round = 0; round < 3000; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const auto list = random_strands(random, random.whole(1, 6));
    const Kernel kernel = random_kernel(random, round);
    const Ball ball{random.vector(2.5), pow(10.0, random.between(-3, 0))};
    const DistancesInReach reach = distances_in_reach(list, kernel, ball);
    ASSERT_EQ(reach.segments.strands.size(), reach.segments.size());
    all += list.size();
    left += reach.segments.size();
    ends += reach.ends.size();
    for (int i = 0; i < 20; ++i) {
      const double share = i % 2 == 0 ? 1 : random.between(0, 1);  // on the sphere as often as in it
      const Vec3d p = ball.center + normalize(random.vector(1)) * (ball.radius * share);
      const double exact = sum_of_strands(list, p, kernel);
      if (!(exact < 1e30)) continue;
      double sum = sum_of_strands(reach.segments, p, kernel);
      for (const PointSkeleton& end : reach.ends) sum += point_field<Derivatives::ScaleInvariant>(end, p, kernel).value;
      worst = std::max(worst, std::fabs(sum - exact) / (1e-12 + exact));
    }
  }
  std::cout << "  " << all << " segments, " << left << " and " << ends << " ends left, off by at most " << worst
            << '\n';
  EXPECT_LT(worst, 1e-10);
  EXPECT_LT(left, all / 3);
  EXPECT_GT(ends, 1000U);
}

// What is nearest in a small ball is one segment or a joint, however long the strand.
TEST(DistancesInReach, AreFewInSmallBalls) {
  Random random(20261129);
  PrimitiveList<SegmentSkeleton> list;
  Vec3d at{};
  for (int i = 0; i < 2000; ++i) {
    const Vec3d next = at + random.vector(0.2);
    list.skeletons.push_back({at, next, 0.03, 0.03});
    list.strands.push_back(0);
    at = next;
  }
  double kept = 0;
  constexpr int count = 300;
  for (int i = 0; i < count; ++i) {
    const Vec3d near = list.skeletons[static_cast<std::size_t>(random.whole(0, 1999))].from + random.vector(0.1);
    const DistancesInReach reach = distances_in_reach(list, {}, {near, 1e-3});
    kept += static_cast<double>(reach.segments.size() + reach.ends.size());
  }
  EXPECT_LT(kept / count, 2);
}

}  // namespace
}  // namespace marrow
