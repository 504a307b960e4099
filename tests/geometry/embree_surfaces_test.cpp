// Embree loses nothing: its hits are those of all elements asked one by one, for the rays that are hardest for it.
#include "renderer/geometry/embree_surfaces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include <gtest/gtest.h>

#include "renderer/geometry/mesh_solid.h"
#include "tests/geometry/scene_of_solids.h"

namespace marrow::test {
namespace {

// Along an axis through a point of a face, an edge or a corner of a cell; or a diagonal through a corner.
Ray touching_box(Random& random, const Box3& box) {
  Vec3d target;
  for (std::size_t i = 0; i < 3; ++i) {
    const double kind = random.between(0, 1);
    target[i] = kind < 0.4 ? box.lower[i] : kind < 0.8 ? box.upper[i] : random.between(box.lower[i], box.upper[i]);
  }
  const auto axis = static_cast<std::size_t>(random.whole(0, 2));
  Vec3d direction{};
  direction[axis] = random.between(0, 1) < 0.5 ? -1 : 1;
  if (random.between(0, 1) < 0.2) direction = random_direction(random);
  return {target - direction * 8.0, normalize(direction)};
}

struct Comparison {
  int rays = 0, hits = 0, lost = 0, differ = 0, occlusion = 0;
  static constexpr int refined_every = 311;

  // Refined now and then, so that rays are asked of elements and of parts of all sizes.
  void check(const SolidScene& scene, const Ray& ray) {
    if (++rays % refined_every == 0) scene.surfaces().refine();
    const auto expected = scene.brute_force(ray);
    const auto found = scene.surfaces().first_hit(ray);
    hits += expected.has_value();
    if (expected.has_value() != found.has_value()) ++lost;
    else if (expected && *expected != found->t) ++differ;
    if (scene.surfaces().occluded(ray) != expected.has_value()) ++occlusion;
  }
  void report(const char* title) const {
    std::cout << "  " << title << ": " << rays << " rays, " << hits << " hits, lost " << lost << ", differing t "
              << differ << ", differing occlusion " << occlusion << '\n';
    EXPECT_EQ(lost, 0) << title;
    EXPECT_EQ(differ, 0) << title;
    EXPECT_EQ(occlusion, 0) << title;
    EXPECT_GT(hits, rays / 10) << title;
  }
};

TEST(EmbreeSurfaces, EqualsBruteForce) {
  Random random(101);
  Comparison near, offset, afar;
  const Vec3d away{1000, 1000, -1000};
  for (const double alpha : {contact_alpha(4), 0.0, 1.3}) {
    const BlendField blend = random_scene(random, {4, alpha}, 5);
    const SolidScene scene({placed(blend)}), shifted({placed(moved(blend, away))});
    for (int i = 0; i < 2300; ++i) {
      const Ray ray = i % 2 ? touching_box(random, scene.random_box(random)) : any_ray(random, blend);
      near.check(scene, ray);
      const Ray there = i % 2 ? touching_box(random, shifted.random_box(random)) : moved(any_ray(random, blend), away);
      offset.check(shifted, there);
      afar.check(scene, from_afar(ray, 1e5));
    }
  }
  near.report("at the origin");
  offset.report("1000 away from it");
  afar.report("seen from 1e5");
}

// To the last bit, although t is another one in the blend's own coordinates; also behind the origin of the ray.
void expect_limits_kept(const SolidScene& scene, Ray ray, double t) {
  ray.t_max = t;
  const auto there = scene.surfaces().first_hit(ray);
  ASSERT_TRUE(there);
  EXPECT_EQ(there->t, t);
  ray.t_max = std::nextafter(t, 0.0);
  EXPECT_FALSE(scene.surfaces().first_hit(ray));
  Ray behind = ray;
  behind.origin = ray.at(2 * t);
  behind.t_min = ray.t_min - 2 * t;
  behind.t_max = -0.5 * t;
  const auto hit = scene.surfaces().first_hit(behind);
  ASSERT_TRUE(hit);
  behind.t_max = hit->t;
  const auto again = scene.surfaces().first_hit(behind);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->t, hit->t);
}

// Non-uniform scale, shear and rotation stay above the blend; its rays are mapped.
TEST(EmbreeSurfaces, EqualsBruteForceUnderTransforms) {
  Random random(102);
  Comparison all;
  double worst = 0;
  for (int k = 0; k < 3; ++k) {
    const Affine bend = Affine::translate(random.vector(0.5)) *
                        Affine::rotate(normalize(random_direction(random)), random.between(0, 3)) *
                        Affine::scale({random.between(0.4, 1), random.between(0.8, 1.6), -random.between(0.5, 1.3)});
    const BlendField one = random_scene(random, {4, contact_alpha(4)}, 4), other = random_scene(random, {3, 1.2}, 2);
    const SolidScene scene({placed(one, bend), placed(other)});
    for (int i = 0; i < 1200; ++i) {
      const Ray ray = any_ray(random, one);
      all.check(scene, ray);
      const auto hit = scene.surfaces().first_hit(ray);
      if (!hit) continue;
      expect_limits_kept(scene, ray, hit->t);
      // On the exact surface of the union, in world space, and with its normal.
      const FieldSample exact = scene.sample(hit->position);
      const double slope = length(exact.gradient);
      worst = std::max(worst, std::fabs(exact.value - 1) / slope);
      const double off = length(hit->normal + normalize(exact.gradient).vec());
      EXPECT_LT(off, 1e-4 / std::min(1.0, slope));
      EXPECT_LT(length(hit->position - ray.at(hit->t)), 1e-9 * (1 + hit->t));
    }
  }
  all.report("transformed");
  std::cout << "  largest distance from the exact surface " << worst << '\n';
  EXPECT_LT(worst, 2e-5);
}

// One tracer at several places gives the bits of several tracers.
TEST(EmbreeSurfaces, PlacedAgainIsPlacedTheSame) {
  Random random(106);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 5);
  std::vector<PlacedSolid> shared, apart;
  std::unique_ptr<FieldSolid> first;
  for (int i = 0; i < 4; ++i) {
    const Affine map = Affine::translate(random.vector(2)) *
                       Affine::rotate(normalize(random_direction(random)), random.between(0, 3)) *
                       Affine::scale({0.7, 0.7, 0.7});
    auto made = FieldSolid::make(placed(blend, map), MaterialId{3}, {});
    ASSERT_TRUE(made);
    if (i == 0) first = std::move(*FieldSolid::make(placed(blend), MaterialId{}, {}));
    shared.push_back({first->placed_again(placed(blend, map), MaterialId{3}), ObjectId{0}});
    apart.push_back({std::move(*made), ObjectId{0}});
  }
  const auto a = EmbreeSurfaces::make(std::move(shared), {}, "threads=1"),
             b = EmbreeSurfaces::make(std::move(apart), {}, "threads=1");
  ASSERT_TRUE(a && b);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d from = random_direction(random) * 12;
    const Ray ray{from, normalize(random.vector(2) - from)};
    const auto x = (*a)->first_hit(ray), y = (*b)->first_hit(ray);
    ASSERT_EQ(x.has_value(), y.has_value());
    if (!x) continue;
    ++hits;
    EXPECT_EQ(x->t, y->t);
    EXPECT_EQ(x->normal.vec(), y->normal.vec());
    EXPECT_EQ(x->outside, y->outside);
    EXPECT_EQ(x->material, MaterialId{3});
  }
  EXPECT_GT(hits, 500);
}

// Flat boxes, and rays that run in their faces and edges.
MeshShape small_triangles(Random& random, const Vec3d& at) {
  MeshShape mesh;
  for (std::uint32_t i = 0; i < 600; i += 3) {
    const Vec3d corner = at + random.vector(2), side{random.between(0.05, 0.3), 0, 0},
                up{0, random.between(0.05, 0.3), 0};
    for (const Vec3d& p : {corner, corner + side, corner + up}) mesh.positions.push_back(p);
    mesh.triangles.push_back({i, i + 1, i + 2});
  }
  return mesh;
}

TEST(EmbreeSurfaces, LosesNoRayAlongTheFacesOfFlatBoxes) {
  Random random(103);
  int rays = 0, hits = 0, lost = 0;
  for (const double place : {0.0, 1000.0}) {
    const MeshShape mesh = small_triangles(random, {place, place, place});
    const MeshSolid alone(mesh, MaterialId{});
    std::vector<PlacedSolid> solids;
    solids.push_back({std::make_unique<MeshSolid>(mesh, MaterialId{}), ObjectId{0}});
    const auto made = EmbreeSurfaces::make(std::move(solids), {}, "threads=1");
    ASSERT_TRUE(made);
    for (int i = 0; i < 15000; ++i, ++rays) {
      const auto& t = mesh.triangles[static_cast<std::size_t>(random.whole(0, 199))];
      Vec3d target = lerp(mesh.positions[t[0]], mesh.positions[t[1]], random.between(0, 1));
      if (i % 3 == 0) target = lerp(mesh.positions[t[0]], mesh.positions[t[2]], random.between(0, 1));
      const Ray ray{target + Vec3d{0, 0, i % 2 ? 8.0 : 1e5}, UnitVec3::unchecked({0, 0, -1})};
      bool expected = false;
      for (std::size_t k = 0; k < alone.element_count() && !expected; ++k) {
        ElementLog log;
        expected = alone.hit(k, ray, false, log).has_value();
      }
      hits += expected;
      lost += expected != (*made)->first_hit(ray).has_value();
    }
  }
  std::cout << "  " << rays << " rays along edges, " << hits << " hits, lost " << lost << '\n';
  EXPECT_GT(hits, rays / 10);
  EXPECT_EQ(lost, 0);
}

// Doubles tell places 1e12 sizes away to 1e-4 of the size: what is hit there may as well not be on the ray, and what is
// not hit may be.
TEST(EmbreeSurfaces, NothingIsCertifiedFromWhereNoDigitsAreLeft) {
  Random random(108);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 5);
  const SolidScene scene({placed(blend)});
  for (const double distance : {1e3, 1e6, 1e12, 1e14}) {
    std::vector<Ray> rays;
    for (int i = 0; i < 600; ++i) rays.push_back(from_afar(any_ray(random, blend), distance));
    std::vector<std::optional<SurfaceHit>> hits(rays.size());
    std::vector<RayRecord> records(rays.size());
    scene.surfaces().first_hits(rays, hits, records);
    int met = 0, certified = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RayRecord alone;
      scene.surfaces().first_hit(rays[i], alone);
      EXPECT_EQ(alone.certified, records[i].certified);
      met += hits[i].has_value();
      certified += hits[i] && records[i].certified;
      if (distance > 1e9) { EXPECT_FALSE(records[i].certified) << distance; }
    }
    EXPECT_GT(met, 50) << distance;
    if (distance < 1e9) { EXPECT_GT(certified, 0.98 * met) << distance; }
  }
}

// Two balls, of which one mirrors the other: the plane between them is a face of cells. A ray that meets the surface
// there leaves an undecided gap at the end of one cell, and the other has the hit; half of these were told as not
// certified.
TEST(EmbreeSurfaces, HitsInTheFaceBetweenTwoCellsAreCertified) {
  Random random(109);
  BlendField blend;
  blend.alpha = contact_alpha(4);
  blend.points.add({{-0.4, 0, 0}, 0.5}, {});
  blend.points.add({{0.4, 0, 0}, 0.5}, {});
  double inside = 0.1, outside = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (corrected_value(blend, {0, middle, 0}) > 1 ? inside : outside) = middle;
  }
  const SolidScene scene({placed(blend)});
  int rays = 0;
  for (int i = 0; i < 400; ++i) {
    const double angle = random.between(-std::numbers::pi, std::numbers::pi);
    const Vec3d normal{0, std::cos(angle), std::sin(angle)};
    const UnitVec3 direction = normalize(random_direction(random));
    if (dot(direction, normal) > -0.3) continue;
    ++rays;
    RayRecord record;
    const auto hit = scene.surfaces().first_hit({inside * normal - 1.5 * direction, direction}, record);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 1.5, 1e-5);
    EXPECT_TRUE(record.certified) << "ray " << i;
    if (i == 200) scene.surfaces().refine();
  }
  EXPECT_GT(rays, 100);
}

// Answers are the same before, after and while surfaces are refined, also of rays that begin inside.
TEST(EmbreeSurfaces, AreRefinedWhileRaysAreUnderWay) {
  Random random(107);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 5);
  const SolidScene scene({placed(blend)});
  std::atomic<bool> done = false;
  std::thread refining([&] {
    while (!done) scene.surfaces().refine();
  });
  int hits = 0, inside = 0, differ = 0;
  for (int i = 0; i < 6000; ++i) {
    Ray ray = any_ray(random, blend);
    if (i % 3 == 0) ray.origin = random.vector(1.5);
    inside += scene.value(ray.origin) >= 1;
    RayRecord record;
    const auto elements = scene.surfaces().first_hit(ray, record), parts = scene.surfaces().first_hit(ray);
    hits += elements.has_value();
    differ += elements.has_value() != parts.has_value() ||
              (elements && (elements->t != parts->t || !(elements->outside == parts->outside)));
  }
  done = true;
  refining.join();
  EXPECT_EQ(differ, 0);
  EXPECT_GT(hits, 1000);
  EXPECT_GT(inside, 20);
}

TEST(EmbreeSurfaces, OfNothingHitsNothing) {
  const auto made = EmbreeSurfaces::make({}, {}, "threads=1");
  ASSERT_TRUE(made);
  EXPECT_TRUE((*made)->bounds().empty());
  EXPECT_FALSE((*made)->first_hit({{0, 0, 5}, UnitVec3::unchecked({0, 0, -1})}));
  EXPECT_FALSE((*made)->occluded({{0, 0, 5}, UnitVec3::unchecked({0, 0, -1})}));
}

TEST(EmbreeSurfaces, PlanesCompeteWithSolids) {
  std::vector<PlacedSolid> solids;
  auto solid = FieldSolid::make(placed(ball({0, 0, 0}, 1)), MaterialId{}, {});
  ASSERT_TRUE(solid);
  solids.push_back({std::move(*solid), ObjectId{0}});
  const PlacedPlane floor{{0, 0, -2}, UnitVec3::unchecked({0, 0, 1}), MaterialId{}, ObjectId{1}};
  const auto made = EmbreeSurfaces::make(std::move(solids), {floor}, "threads=1");
  ASSERT_TRUE(made);
  const auto above = (*made)->first_hit({{0.1, 0.2, 5}, UnitVec3::unchecked({0, 0, -1})});
  ASSERT_TRUE(above);
  EXPECT_EQ(above->object, ObjectId{0});
  EXPECT_NEAR(above->t, 5 - std::sqrt(0.95), 1e-4);
  const auto beside = (*made)->first_hit({{1.1, 0.2, 5}, UnitVec3::unchecked({0, 0, -1})});
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->object, ObjectId{1});
  EXPECT_EQ(beside->t, 7);
  const auto below = (*made)->first_hit({{0.1, 0.2, -5}, UnitVec3::unchecked({0, 0, 1})});
  ASSERT_TRUE(below);
  EXPECT_EQ(below->object, ObjectId{1});
}

}  // namespace
}  // namespace marrow::test
