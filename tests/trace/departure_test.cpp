// Rays that leave a surface by what is known of the field there meet what rays meet that sum it anew.
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/trace/all_cells.h"
#include "tests/trace/oracle.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Every second one close to the tangent plane.
UnitVec3 outward(Random& random, const UnitVec3& normal) {
  Vec3d direction = random_direction(random);
  if (dot(direction, normal) < 0) direction = -direction;
  if (random.whole(0, 1) == 0) direction = direction - normal * (dot(direction, normal) * random.between(0.9, 0.9999));
  return normalize(direction);
}

struct Counts {
  int rays = 0, hits = 0, apart = 0;
};

// Where one of them passes a surface that the other one meets, there is hardly anything to meet.
void expect_like(const AllCells& cells, const Oracle& oracle, const Ray& known, Counts& count) {
  const auto found = cells.first_hit(known), anew = cells.first_hit({known.origin, known.direction});
  ++count.rays;
  count.hits += found.has_value();
  const double t = found ? found->t : infinity, u = anew ? anew->t : infinity;
  if (t == u || std::fabs(t - u) < 1e-5) return;
  ++count.apart;
  EXPECT_LT(oracle.largest_excess(known, std::min(t, u), std::min(std::max(t, u), std::min(t, u) + 1)), 5e-5)
      << "with what is known " << t << ", anew " << u;
}

class Departure : public testing::TestWithParam<Setting> {};

void expect_like(Random& random, const BlendField& blend, Counts& count) {
  const AllCells cells(blend);
  const Oracle oracle(blend);
  for (int i = 0; i < 1000; ++i) {
    const Ray ray = any_ray(random, blend);
    const auto hit = cells.first_hit(ray);
    if (!hit) continue;
    const SurfacePoint at = cells.tracer().surface_at(hit->cell, ray.at(hit->t));
    ASSERT_NE(at.around.block, nullptr);
    expect_like(cells, oracle, {at.outside, outward(random, at.normal), 0, infinity, &at.around}, count);
  }
}

void expect_few_apart(const Counts& count) {
  std::cout << "  " << count.rays << " rays, " << count.hits << " hits, " << count.apart << " apart\n";
  EXPECT_GT(count.rays, 500);
  EXPECT_LT(count.apart, count.rays / 100);
}

TEST_P(Departure, MeetsWhatIsMetAnew) {
  Random random(171);
  Counts count;
  for (int i = 0; i < 3; ++i) expect_like(random, random_scene(random, GetParam(), random.whole(2, 9)), count);
  expect_few_apart(count);
}

TEST(Departure, MeetsWhatIsMetAnewWhereDirectionsGiveTheAngle) {
  Random random(173);
  Counts count;
  for (const int n : {3, 4, 5}) expect_like(random, random_stranded_scene(random, {n, 1}, 7), count);
  const BlendField own = with_own_bounds(random_stranded_scene(random, {4, 1}, 7), random);
  expect_like(random, own, count);
  expect_like(random, with_angles_below_zero(own, random), count);
  expect_few_apart(count);
}

INSTANTIATE_TEST_SUITE_P(Trace, Departure,
                         testing::Values(Setting{3, 1.0}, Setting{4, contact_alpha(4)}, Setting{4, -0.4},
                                         Setting{4, std::numbers::pi / 2}, Setting{4, 0.8, false}, Setting{5, 0},
                                         Setting{7, 1.2}));

// What is known of another place counts for nothing, to the same bits.
TEST(Departure, OfAnotherPlaceCountsForNothing) {
  Random random(172);
  const AllCells cells(random_scene(random, {4, contact_alpha(4)}, 6));
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = any_ray(random, cells.tracer().field());
    const auto hit = cells.first_hit(ray);
    if (!hit) continue;
    const SurfacePoint at = cells.tracer().surface_at(hit->cell, ray.at(hit->t));
    const Vec3d elsewhere = at.outside + at.normal * random.between(0.02, 0.1);
    const UnitVec3 back = normalize(random_direction(random) - at.normal.vec());
    const auto found = cells.first_hit({elsewhere, back, 0, infinity, &at.around}),
               expected = cells.first_hit({elsewhere, back});
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (!found) continue;
    ++hits;
    ASSERT_EQ(found->t, expected->t);
  }
  EXPECT_GT(hits, 300);
}

}  // namespace
}  // namespace marrow::test
