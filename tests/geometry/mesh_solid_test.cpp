// Meshes and planes: closed ones have no gaps, and further rays start on the side their ray came from, however far away
// that began.
#include "renderer/geometry/mesh_solid.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "renderer/geometry/embree_surfaces.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

// A ball of radius about 1 in rings of slanted triangles.
MeshShape ball(const Vec3d& center) {
  constexpr int around = 24, along = 12;
  MeshShape mesh;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i < around; ++i) {
      const double a = std::numbers::pi * j / along, b = 2 * std::numbers::pi * i / around;
      mesh.positions.push_back(center + Vec3d{sin(a) * cos(b), cos(a), sin(a) * sin(b)});
    }
  const auto at = [](int j, int i) { return static_cast<std::uint32_t>(j * around + i % around); };
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      if (j > 0) mesh.triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i + 1)});
      if (j + 1 < along) mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j + 1, i)});
    }
  return mesh;
}

std::unique_ptr<EmbreeSurfaces> surfaces_of(const MeshShape& mesh) {
  std::vector<PlacedSolid> solids;
  solids.push_back({std::make_unique<MeshSolid>(mesh, MaterialId{}), ObjectId{0}});
  return std::move(*EmbreeSurfaces::make(std::move(solids), {}, "threads=1"));
}

// Through a corner or an edge of the mesh, or anywhere through its middle.
Vec3d aim(Random& random, const MeshShape& mesh, const Vec3d& center) {
  const auto corner = [&](std::uint32_t i) { return mesh.positions[i]; };
  const auto& t =
      mesh.triangles[static_cast<std::size_t>(random.whole(0, static_cast<int>(mesh.triangles.size()) - 1))];
  const double kind = random.between(0, 1);
  if (kind < 0.3) return corner(t[0]);
  if (kind < 0.6) return lerp(corner(t[0]), corner(t[1]), random.between(0, 1));
  return center + random.vector(0.5);
}

TEST(MeshSolid, OfAClosedBodyIsMetFromAnyDistanceAndLeftOutward) {
  Random random(121);
  int hits = 0;
  for (const double distance : {3.0, 30.0, 1e3, 1e6})
    for (const Vec3d& center : {Vec3d{}, Vec3d{30, -20, 10}}) {
      const MeshShape mesh = ball(center);
      const auto surfaces = surfaces_of(mesh);
      for (int i = 0; i < 2000; ++i) {
        // From outside to the inside, through what lies between.
        const Vec3d inside = center + (aim(random, mesh, center) - center) * random.between(0.1, 0.9);
        const Vec3d from = center + random_direction(random) * distance;
        const auto hit = surfaces->first_hit({from, normalize(inside - from)});
        ASSERT_TRUE(hit) << "a gap, from " << distance;
        ++hits;
        EXPECT_LT(hit->t, length(inside - from));
        EXPECT_LT(length(hit->position - center), 1 + 1e-9 * distance);
        // A convex body is not met again by what leaves on the outer side.
        const Vec3d out = random_direction(random);
        const Ray onward{hit->outside, normalize(dot(out, hit->normal) < 0 ? -out : out)};
        EXPECT_FALSE(surfaces->first_hit(onward)) << "from " << distance;
      }
    }
  EXPECT_GT(hits, 10000);
}

TEST(MeshSolid, PlanesAreLeftOnTheSideOfTheRay) {
  Random random(122);
  const UnitVec3 normal = normalize(Vec3d{0.3, 1, -0.2});
  const auto made = EmbreeSurfaces::make({}, {{Vec3d{0.1, 0.2, 0.3}, normal, MaterialId{}, ObjectId{0}}}, "threads=1");
  ASSERT_TRUE(made);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d from = random_direction(random) * std::exp2(random.between(0, 20));
    const auto hit = (*made)->first_hit({from, normalize(random.vector(1) - from)});
    if (!hit) continue;
    const double side = dot(normal, from - Vec3d{0.1, 0.2, 0.3}) > 0 ? 1 : -1;
    EXPECT_GT(side * dot(normal, hit->outside - Vec3d{0.1, 0.2, 0.3}), 0) << length(from);
  }
}

}  // namespace
}  // namespace marrow::test
