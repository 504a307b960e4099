// Rays asked side by side get what each gets alone, to the last bit.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "renderer/geometry/mesh_solid.h"
#include "renderer/geometry/tree_solid.h"
#include "tests/geometry/boolean_scene.h"
#include "tests/geometry/scene_of_solids.h"
#include "tests/trace/instruction_sets.h"
#include "tests/tree/random_tree.h"

namespace marrow::test {
namespace {

using Hits = std::vector<std::optional<SurfaceHit>>;
using Rays = std::vector<Ray>;

constexpr int together = RayPacket::size + 36;  // more than go into a packet

MeshShape shards(Random& random) {
  MeshShape mesh;
  for (std::uint32_t i = 0; i < 90; i += 3) {
    const Vec3d at = random.vector(2);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + random.vector(0.4));
    mesh.triangles.push_back({i, i + 1, i + 2});
  }
  return mesh;
}

// The blend without a ball and what is behind a plane, beside another blend.
FieldTree cut(Random& random, const BlendField& blend) {
  RandomTree tree(random);
  const auto leaf = [&](BlendField b) { return tree.leaf(BlendLeaf{std::make_shared<BlendField>(std::move(b))}); };
  const Affine aside = Affine::translate({0, 3, 0});
  const std::uint32_t ball = tree.leaf(Sphere{.center = random.vector(0.7), .radius = 0.6, .potential = {}}),
                      plane = tree.leaf(Plane{.point = {}, .normal = normalize(random.vector(1)), .potential = {}}),
                      whole = leaf(blend), other = leaf(random_scene(random, {3, 1}, 4));
  const std::uint32_t both = tree.record(CrispUnion{}, {other, whole});
  tree.record(AffineWarp{aside, aside.inverse()},
              {tree.record(Difference{}, {random.between(0, 1) < 0.5 ? whole : both, plane, ball})});
  return tree.tree();
}

// Everything that rays can meet: blends in the world's coordinates and in their own, one at several places, a general
// tree, blends under set operations, triangles, planes.
std::unique_ptr<EmbreeSurfaces> everything(Random& random, const BlendField& blend, const TraceOptions& options,
                                           const std::string& config) {
  const Affine bend = Affine::translate(random.vector(1)) *
                      Affine::rotate(normalize(random_direction(random)), random.between(0, 3)) *
                      Affine::scale({random.between(0.4, 1), random.between(0.8, 1.6), -random.between(0.5, 1.3)});
  std::vector<PlacedSolid> solids;
  const auto add = [&](std::unique_ptr<Solid> solid) { solids.push_back({std::move(solid), ObjectId{solids.size()}}); };
  auto first = std::move(*FieldSolid::make(placed(blend), MaterialId{1}, options));
  add(first->placed_again(placed(blend, bend), MaterialId{2}));
  add(first->placed_again(placed(blend, Affine::translate(random.vector(2))), MaterialId{3}));
  add(std::move(first));
  add(std::move(*FieldSolid::make(placed(random_scene(random, {3, 1.2}, 3), bend), MaterialId{4}, options)));
  add(std::move(*TreeSolid::make(tree_of(placed(random_scene(random, {4, 0.7}, 2))), MaterialId{5})));
  add(boolean_solid_of(cut(random, blend), 2, MaterialId{9}, options));
  add(std::make_unique<MeshSolid>(shards(random), MaterialId{6}));
  std::vector<PlacedPlane> planes{{{0, -2, 0}, UnitVec3::unchecked({0, 1, 0}), MaterialId{7}, ObjectId{solids.size()}},
                                  {{3, 0, 0}, normalize(Vec3d{-1, 0.3, 0.2}), MaterialId{8}, ObjectId{7}}};
  return std::move(*EmbreeSurfaces::make(std::move(solids), std::move(planes), config));
}

// Rays through neighbouring points, from a place or side by side.
Rays of_a_camera(Random& random) {
  const Vec3d target = random.vector(1.6), eye = random_direction(random) * (random.between(0, 1) < 0.2 ? 1e5 : 7);
  const Frame frame = Frame::around(normalize(eye - target));
  const double spacing = std::exp2(random.between(-12, -1));
  const bool parallel = random.between(0, 1) < 0.3;
  Rays rays;
  for (int i = 0; i < together; ++i) {
    const Vec3d aside = frame.to_world({spacing * (i % 8), spacing * (i / 8), 0});
    rays.push_back(parallel ? Ray{eye + aside, -frame.z} : between(eye, target + aside));
  }
  return rays;
}

// Along an axis, through faces, edges and corners of elements' boxes.
Rays of_faces(Random& random, const EmbreeSurfaces& surfaces) {
  const auto pick = [&](std::size_t size) {
    return static_cast<std::size_t>(random.whole(0, static_cast<int>(size) - 1));
  };
  const auto axis = pick(3);
  Vec3d direction{};
  direction[axis] = random.between(0, 1) < 0.5 ? -1 : 1;
  const double distance = random.between(0, 1) < 0.2 ? 1e5 : 8;
  Rays rays;
  for (int i = 0; i < together; ++i) {
    const Solid& solid = *surfaces.solids()[pick(surfaces.solids().size())].solid;
    const Box3 box = solid.element_box(pick(solid.element_count()));
    Vec3d target;
    for (std::size_t k = 0; k < 3; ++k) {
      const double kind = random.between(0, 1);
      target[k] = kind < 0.4 ? box.lower[k] : kind < 0.8 ? box.upper[k] : random.between(box.lower[k], box.upper[k]);
    }
    // One in eight slants, so that the packet is no bundle of parallels
    const Vec3d slant = i % 8 == 7 ? direction + random.vector(0.1) : direction;
    rays.push_back({target - slant * distance, normalize(slant)});
  }
  return rays;
}

// From where other rays met something, toward the sun.
Rays of_shadows(Random& random, const Surfaces& surfaces) {
  const UnitVec3 toward_sun = normalize(random_direction(random));
  Rays rays;
  for (const Ray& ray : of_a_camera(random))
    if (const auto hit = surfaces.first_hit(ray)) rays.push_back({hit->outside, toward_sun});
  return rays;
}

// With ends and beginnings anywhere: at the hit and just before it, inside of bodies.
Rays of_all_kinds(Random& random, const Surfaces& surfaces, const BlendField& blend) {
  Rays rays = of_a_camera(random);
  for (Ray& ray : rays) {
    const double kind = random.between(0, 1);
    if (kind < 0.3) ray = any_ray(random, blend);
    if (kind < 0.1) ray.origin = random.vector(1.5);
    const auto hit = surfaces.first_hit(ray);
    const double t = hit ? hit->t : random.between(0, 10), end = random.between(0, 1);
    if (end < 0.2) ray.t_max = end < 0.1 ? t : std::nextafter(t, 0.0);
    else if (end < 0.4) ray.t_min = t * random.between(0.5, 1.1);
  }
  return rays;
}

struct Comparison {
  int rays = 0, hits = 0, hidden = 0, differ = 0;

  // `whole` is the same and never refined.
  void check(const Surfaces& surfaces, const Surfaces& whole, std::span<const Ray> batch) {
    Hits found(batch.size()), recorded(batch.size());
    surfaces.first_hits(batch, found);
    std::vector<RayRecord> records(batch.size());
    surfaces.first_hits(batch, recorded, records);
    std::vector<std::uint8_t> occluded(batch.size(), 7);
    surfaces.occluded(batch, occluded);
    for (std::size_t i = 0; i < batch.size(); ++i, ++rays) {
      const auto expected = surfaces.first_hit(batch[i]);
      const bool hides = surfaces.occluded(batch[i]);
      hits += expected.has_value();
      hidden += hides;
      for (const Surfaces* each : {&surfaces, &whole}) {
        RayRecord record;
        differ += !same(each->first_hit(batch[i], record), recorded[i]) ||
                  record.evaluations != records[i].evaluations || record.certified != records[i].certified;
      }
      differ += !same(expected, found[i]) || occluded[i] != (hides ? 1 : 0);
      // Whatever is nearest: also at the ray's end, or in a body where it begins
      differ += hides != expected.has_value() || hides != whole.occluded(batch[i]);
    }
  }
  static bool same(const std::optional<SurfaceHit>& a, const std::optional<SurfaceHit>& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    return a->t == b->t && a->position == b->position && a->normal == b->normal && a->outside == b->outside &&
           a->object == b->object && a->material == b->material;
  }
  void report(const std::string& title) const {
    std::cout << "  " << title << ": " << rays << " rays, " << hits << " hits, " << hidden << " hidden, " << differ
              << " differ\n";
    EXPECT_EQ(differ, 0) << title;
    EXPECT_GT(hits, rays / 5) << title;
    EXPECT_LT(hits, rays) << title;
  }
};

// The same twice: to be refined, and never.
struct Twins {
  std::unique_ptr<EmbreeSurfaces> surfaces, whole;
};
Twins twins(Random& random, const BlendField& blend, const std::string& isa) {
  const std::string config = "threads=1,max_isa=" + (isa == "sse4" ? "sse4.2" : isa);
  Random again = random;
  return {everything(random, blend, {.instruction_set = isa}, config),
          everything(again, blend, {.instruction_set = isa}, config)};
}

// Packets of sixteen, eight and four here and in Embree, or single rays, and from whole elements down to single cells.
TEST(RayPackets, EqualSingleRays) {
  for (const std::string& isa : sets_here()) {
    Random random(131);
    Comparison camera, faces, shadows, mixed, few;
    const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 5);
    const auto [surfaces, whole] = twins(random, blend, isa);
    for (int i = 0; i < 80; ++i) {
      if (i % 15 == 14) surfaces->refine();
      camera.check(*surfaces, *whole, of_a_camera(random));
      faces.check(*surfaces, *whole, of_faces(random, *surfaces));
      shadows.check(*surfaces, *whole, of_shadows(random, *surfaces));
      const Rays rays = of_all_kinds(random, *surfaces, blend);
      mixed.check(*surfaces, *whole, rays);
      few.check(*surfaces, *whole, std::span(rays).first(static_cast<std::size_t>(random.whole(0, 5))));
    }
    camera.report(isa + ", of a camera");
    faces.report(isa + ", of faces");
    shadows.report(isa + ", of shadows");
    mixed.report(isa + ", of all kinds");
    few.report(isa + ", of few rays");
  }
}

// Nearly along one axis, some all but exactly: what rotations leave of 0, and what is too small for an inverse in
// float.
Rays near_an_axis(Random& random) {
  constexpr double almost_none[] = {0, -0.0, 1e-17, -1e-17, 1.1e-18, -1.1e-18, -9e-19, 1e-30, -1e-30, -1e-320};
  const auto axis = static_cast<std::size_t>(random.whole(0, 2));
  const double way = random.between(0, 1) < 0.5 ? -1 : 1;
  const Vec3d center = random.vector(1.2);
  Rays rays;
  for (int i = 0; i < together; ++i) {
    Vec3d direction = random.vector(0.05), target = center + random.vector(0.2);
    if (i % 4 == 0)
      for (const std::size_t k : {(axis + 1) % 3, (axis + 2) % 3}) direction[k] = almost_none[random.whole(0, 9)];
    direction[axis] = way;
    const UnitVec3 d = i % 4 == 0 ? UnitVec3::unchecked(direction) : normalize(direction);
    rays.push_back({target - d * 7, d});
  }
  return rays;
}

TEST(RayPackets, EqualSingleRaysNearAnAxis) {
  for (const std::string& isa : sets_here()) {
    Random random(133);
    Comparison all;
    const BlendField blend = random_scene(random, {4, 0.3}, 5);
    const auto [surfaces, whole] = twins(random, blend, isa);
    for (int i = 0; i < 80; ++i) {
      if (i % 15 == 14) surfaces->refine();
      all.check(*surfaces, *whole, near_an_axis(random));
    }
    all.report(isa + ", near an axis");
  }
}

// Coordinates of which floats keep four digits behind the point, or two: then Embree comes into boxes in another order
// than doubles do.
TEST(RayPackets, EqualSingleRaysFarFromTheOrigin) {
  for (const double distance : {1e3, 6e4}) {
    Random random(132);
    Comparison all;
    const Vec3d away = Vec3d{1, 1, -1} * distance;
    const BlendField blend = random_scene(random, {4, 0.3}, 5);
    const SolidScene scene({placed(moved(blend, away))}), whole({placed(moved(blend, away))});
    for (int i = 0; i < 180; ++i) {
      if (i % 40 == 39) scene.surfaces().refine();
      Rays rays = of_a_camera(random);
      for (Ray& ray : rays) ray = moved(ray, away);
      all.check(scene.surfaces(), whole.surfaces(), rays);
      all.check(scene.surfaces(), whole.surfaces(), of_faces(random, scene.surfaces()));
    }
    all.report(std::to_string(distance) + " away from the origin");
  }
}

TEST(RayPackets, OfNothingHitNothing) {
  const auto made = EmbreeSurfaces::make({}, {}, "threads=1");
  ASSERT_TRUE(made);
  const Rays rays(together, Ray{{0, 0, 5}, UnitVec3::unchecked({0, 0, -1})});
  Hits hits(rays.size(), SurfaceHit{});
  (*made)->first_hits(rays, hits);
  for (const auto& hit : hits) EXPECT_FALSE(hit);
  std::vector<std::uint8_t> hidden(rays.size(), 1);
  (*made)->occluded(rays, hidden);
  EXPECT_EQ(hidden, std::vector<std::uint8_t>(rays.size(), 0));
}

}  // namespace
}  // namespace marrow::test
