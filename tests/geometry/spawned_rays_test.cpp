// Rays that leave a surface start outside it, close to it, and do not meet a convex one again.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/geometry/scene_of_solids.h"

namespace marrow::test {
namespace {

TEST(SpawnedRays, StartOutside) {
  Random random(111);
  int hits = 0, wrong = 0;
  double farthest = 0, sum = 0;
  for (const int n : {3, 4, 5})
    for (const double alpha : {contact_alpha(n), 0.3, std::numbers::pi / 2, -0.4}) {
      const BlendField blend = random_scene(random, {n, alpha}, 6);
      const SolidScene scene({placed(blend)});
      for (int i = 0; i < 4500; ++i) {
        const Ray ray = i % 2 ? chord(random) : tangent(random, blend);
        const auto hit = scene.surfaces().first_hit(ray);
        if (!hit) continue;
        ++hits;
        wrong += !(scene.value(hit->outside) < 1);
        const double lift = length(hit->outside - hit->position);
        farthest = std::max(farthest, lift);
        sum += lift;
      }
    }
  std::cout << "  " << hits << " hits, " << wrong << " starts inside, lifted by " << sum / hits << " on average, "
            << farthest << " at most (radii 0.1 to 0.5)\n";
  EXPECT_GE(hits, 20000);
  EXPECT_EQ(wrong, 0);
  EXPECT_LT(sum / hits, 2e-4);
}

// Rays that go on inward from a hit: those that begin at it, on either side of the surface by rounding, meet it where
// they begin or go on to where they leave, and a millionth behind it it is passed.
TEST(SpawnedRays, LeaveBehindWhatTheyGoThrough) {
  constexpr double steep = 0.5, near = 1e-4;
  Random random(113);
  int hits = 0, met_again = 0, met_behind = 0;
  double most_off = 0;
  for (const int n : {3, 5, 8})
    for (const double alpha : {contact_alpha(n), std::numbers::pi / 2}) {
      const SolidScene scene({placed(random_scene(random, {n, alpha}, 6))});
      for (int i = 0; i < 1500; ++i) {
        const Ray ray = chord(random);
        const auto hit = scene.surfaces().first_hit(ray);
        if (!hit || dot(hit->normal, ray.direction) > -steep) continue;
        ++hits;
        Vec3d inward = random_direction(random);
        if (dot(inward, hit->normal) > 0) inward = -inward;
        for (const Ray& on :
             {Ray{hit->position, normalize(inward - hit->normal.vec())}, Ray{ray.origin, ray.direction, hit->t}}) {
          const auto next = scene.surfaces().first_hit(on);
          if (!next || next->t - on.t_min > near || dot(next->normal, on.direction) > 0) continue;
          ++met_again;
          most_off = std::max(most_off, std::fabs(scene.value(next->position) - 1));
        }
        const auto behind = scene.surfaces().first_hit({ray.origin, ray.direction, hit->t + 1e-6});
        met_behind += behind && behind->t - hit->t < near && dot(behind->normal, ray.direction) < 0;
      }
    }
  std::cout << "  " << hits << " hits, " << met_again << " met again, field off 1 by " << most_off << " at most, "
            << met_behind << " met a millionth behind\n";
  EXPECT_GT(hits, 2000);
  EXPECT_LT(most_off, 5e-6);
  EXPECT_LE(met_behind, hits / 1000);
}

// One point, or one segment of constant radius under the plain sum: the sublevel sets of sums of d^-n along a straight
// skeleton are convex.
std::vector<PlacedBlend> convex_bodies(Random& random) {
  std::vector<PlacedBlend> bodies;
  for (const int n : {3, 4, 5}) {
    BlendField ball, capsule;
    ball.degree = capsule.degree = n;
    ball.alpha = contact_alpha(n);
    capsule.alpha = std::numbers::pi / 2;
    ball.points.add({random.vector(1), random.between(0.2, 1)}, {});
    const double radius = random.between(0.2, 0.5);
    capsule.segments.add({random.vector(1), random.vector(1), radius, radius}, {});
    bodies.push_back(placed(ball));
    bodies.push_back(placed(capsule));
    bodies.push_back(placed(capsule, Affine::scale({1, 0.5, 2})));
  }
  return bodies;
}

TEST(SpawnedRays, DoNotMeetAConvexBodyAgain) {
  Random random(112);
  int rays = 0, met = 0;
  for (const PlacedBlend& body : convex_bodies(random)) {
    const SolidScene scene({body});
    for (int i = 0; i < 600; ++i) {
      const Vec3d target = random_in(random, scene.surfaces().bounds());
      const auto hit = scene.surfaces().first_hit(between(random_direction(random) * 20, target));
      if (!hit) continue;
      for (int k = 0; k < 4; ++k) {
        Vec3d direction = random_direction(random);
        if (dot(direction, hit->normal) < 0) direction = -direction;
        // Every second one close to the tangent plane.
        if (k % 2) direction = direction - hit->normal * (dot(direction, hit->normal) * random.between(0.9, 0.9999));
        // With what is known of the field there, and without.
        const Ray leaving = hit->leaving(normalize(direction));
        for (const Ray& spawned : {leaving, Ray{leaving.origin, leaving.direction}}) {
          ++rays;
          met += scene.surfaces().first_hit(spawned).has_value();
          met += scene.surfaces().occluded(spawned);
        }
      }
    }
  }
  std::cout << "  " << rays << " spawned rays, " << met << " met their body again\n";
  EXPECT_GT(rays, 5000);
  EXPECT_EQ(met, 0);
}

}  // namespace
}  // namespace marrow::test
