// Starts of further rays where objects touch: never behind the surface of another one.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/geometry/scene_of_solids.h"

namespace marrow::test {
namespace {

PlacedPlane plane(const Vec3d& point, const Vec3d& normal) {
  return {point, normalize(normal), MaterialId{}, ObjectId{100}};
}

// Each blend is an object of its own.
std::unique_ptr<EmbreeSurfaces> surfaces_of(const std::vector<BlendField>& blends, std::vector<PlacedPlane> planes) {
  std::vector<PlacedSolid> solids;
  for (const BlendField& blend : blends)
    solids.push_back({std::move(*FieldSolid::make(placed(blend), MaterialId{}, {})), ObjectId{solids.size()}});
  return std::move(*EmbreeSurfaces::make(std::move(solids), std::move(planes), "threads=1"));
}

Ray near_contact(Random& random, const Vec3d& contact) {
  const Vec3d from{random.between(-3, 3), random.between(-0.9, 2), random.between(-3, 3)};
  const Vec3d to = contact + random.vector(pow(10, random.between(-9, -1.5)));
  return {from, normalize(to - from)};
}

bool begins_inside(const std::vector<BlendField>& blends, const Ray& ray) {
  return std::ranges::any_of(blends, [&](const BlendField& b) { return corrected_value(b, ray.origin) >= 1; });
}

TEST(StartsBetweenObjects, ABallOnTheFloorBesideOthers) {
  Random random(211);
  const std::vector<BlendField> balls{ball({}, 1), ball({2, 0, 0}, 1), ball({0, 0.5, 1.2}, 0.3)};
  const auto surfaces = surfaces_of(balls, {plane({0, -1, 0}, {0, 1, 0})});
  int hits = 0, below = 0, within = 0;
  for (int i = 0; i < 30000; ++i) {
    const Ray ray = near_contact(random, i % 3 == 0   ? Vec3d{0, -1, 0}
                                         : i % 3 == 1 ? Vec3d{1, 0, 0}
                                                      : Vec3d{0, 5.0 / 13, 12.0 / 13});
    const auto hit = surfaces->first_hit(ray);
    if (!hit || hit->object == ObjectId{100} || begins_inside(balls, ray)) continue;
    ++hits;
    below += hit->outside.y <= -1;
    for (const BlendField& b : balls) within += corrected_value(b, hit->outside) > 1 + 5e-6;
  }
  std::cout << "  " << hits << " hits\n";
  EXPECT_GT(hits, 10000);
  EXPECT_EQ(below, 0);
  EXPECT_EQ(within, 0);
}

// There is no way back, and hardly a step off the surface: what matters is that an answer comes.
TEST(StartsBetweenObjects, FromTheContactItself) {
  Random random(213);
  const auto surfaces = surfaces_of({ball({}, 1), ball({2, 0, 0}, 1)}, {plane({0, -1, 0}, {0, 1, 0})});
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d contact = i % 2 == 0 ? Vec3d{0, -1, 0} : Vec3d{1, 0, 0};
    const auto hit = surfaces->first_hit({contact, normalize(random_direction(random))});
    if (!hit) continue;
    ++hits;
    EXPECT_TRUE(is_finite(hit->outside));
    EXPECT_LE(length(hit->outside - hit->position), 0.1);
  }
  EXPECT_GT(hits, 1000);
}

// Through a thousand bounces, half of them along the surface, no ray gets out of a room whose walls bodies go through.
TEST(StartsBetweenObjects, NoWayOutOfARoom) {
  Random random(212);
  BlendField blend;
  blend.segments.add({{-1, -1, -1}, {0.9, 0.8, 0.7}, 0.1, 0.1}, {});
  blend.points.add({{0, -0.5, 0.5}, 0.5}, {});
  const auto surfaces = surfaces_of(
      {blend}, {plane({1, 0, 0}, {-1, 0, 0}), plane({-1, 0, 0}, {1, 0, 0}), plane({0, 1, 0}, {0, 1, 0}),
                plane({0, -1, 0}, {0, 1, 0}), plane({0, 0, 1}, {1e-3, 0, 1}), plane({0, 0, -1}, {0, 0.01, 1})});
  for (int path = 0; path < 40; ++path) {
    Ray ray{{0.5, 0.5, -0.5}, normalize(random_direction(random))};
    for (int bounce = 0; bounce < 1000; ++bounce) {
      const auto hit = surfaces->first_hit(ray);
      ASSERT_TRUE(hit);
      ASSERT_LT(max_component(abs(hit->outside)), 1.02);
      const Vec3d out = random_direction(random);
      const Vec3d along = cross(hit->normal.vec(), out);
      ray.origin = hit->outside;
      if (random.between(0, 1) < 0.5) ray.direction = normalize(dot(out, hit->normal) < 0 ? -out : out);
      else ray.direction = normalize(normalize(along).vec() + hit->normal.vec() * pow(10, random.between(-8, -1)));
    }
  }
}

}  // namespace
}  // namespace marrow::test
