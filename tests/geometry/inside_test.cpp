// Rays that begin inside: of one body or of what is the union of several, to where they leave, and no further.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "renderer/geometry/tree_solid.h"
#include "tests/geometry/scene_of_solids.h"

namespace marrow::test {
namespace {

struct Body {
  FieldProgram program;
  std::unique_ptr<EmbreeSurfaces> surfaces;
};

// All parts and trees are one object.
Body body_of(std::vector<PlacedBlend> parts, std::vector<FieldTree> trees = {}) {
  Body body{FieldProgram(std::move(parts), std::move(trees)), nullptr};
  std::vector<PlacedSolid> solids;
  for (const PlacedBlend& part : body.program.parts())
    solids.push_back({std::move(*FieldSolid::make(part, MaterialId{}, {})), ObjectId{0}});
  for (const FieldTree& tree : body.program.trees())
    solids.push_back({std::move(*TreeSolid::make(tree, MaterialId{})), ObjectId{0}});
  body.surfaces = std::move(*EmbreeSurfaces::make(std::move(solids), {}, "threads=1"));
  return body;
}

// Into the corner of eight cells that stands on the surface, or beside it.
Ray into_corner(Random& random, const Vec3d& corner) {
  const Vec3d from = random_direction(random) * random.between(0, 0.9);
  const Vec3d to = corner + random_direction(random) * (random.whole(0, 1) * pow(10, random.between(-12, -6)));
  return {from, normalize(to - from)};
}

TEST(Inside, LeavesWhereCellsMeetOnTheSurface) {
  Random random(201);
  const Body body = body_of({placed(ball({}, 1))});
  constexpr std::array axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}};
  int lost = 0, off = 0;
  for (int i = 0; i < 30000; ++i) {
    const Ray ray = into_corner(random, axes[static_cast<std::size_t>(i % 3)]);
    const auto hit = body.surfaces->first_hit(ray);
    if (!hit) ++lost;
    else if (std::fabs(length(hit->position) - 1) > 1e-6) ++off;
  }
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(off, 0);
}

TEST(Inside, NothingIsInTheWayBeforeTheExit) {
  Random random(202);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 5);
  const Body body = body_of({placed(blend)});
  const Box3 bounds = skeleton_bounds(blend).padded(largest_radius(blend));
  std::vector<Ray> rays;
  std::vector<std::uint8_t> expected;
  int inside = 0;
  while (inside < 3000) {
    Ray ray{random_in(random, bounds), normalize(random_direction(random))};
    if (!(value(body.program, ray.origin) > 1.001)) continue;
    ++inside;
    if (inside % 700 == 0) body.surfaces->refine();
    const auto hit = body.surfaces->first_hit(ray);
    ASSERT_TRUE(hit);
    for (const double t_max : {0.5 * hit->t, std::nextafter(hit->t, 0.0), hit->t, 1.5 * hit->t}) {
      ray.t_max = t_max;
      rays.push_back(ray);
      expected.push_back(t_max >= hit->t);
      EXPECT_EQ(body.surfaces->occluded(ray), t_max >= hit->t);
    }
  }
  std::vector<std::uint8_t> hidden(rays.size());
  body.surfaces->occluded(rays, hidden);
  EXPECT_EQ(hidden, expected);
}

// By samples of the union; how far from 1 the field is anywhere before the hit on the other side than at the beginning.
double passed_over(const FieldProgram& program, const Ray& ray, double end) {
  const bool inside = value(program, ray.origin) >= 1;
  double most = 0;
  for (int i = 1; i < 300; ++i) {
    const double f = value(program, ray.at(end * i / 300));
    if ((f >= 1) != inside) most = std::max(most, std::fabs(f - 1));
  }
  return most;
}

struct Met {
  int hits = 0, from_inside = 0;
};

// Of 500 rays that begin anywhere in the bounds of a body.
void expect_no_surface_in_members(Random& random, const Body& body, Met& met) {
  const Box3 bounds = body.surfaces->bounds();
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) rays.push_back({random_in(random, bounds), normalize(random_direction(random))});
  std::vector<std::optional<SurfaceHit>> together(rays.size());
  body.surfaces->first_hits(rays, together);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    if (i == 300) body.surfaces->refine();
    const double begin = value(body.program, ray.origin);
    if (std::fabs(begin - 1) < 1e-4) continue;
    RayRecord record;
    const auto hit = body.surfaces->first_hit(ray, record);
    ASSERT_EQ(hit.has_value(), together[i].has_value());
    ASSERT_TRUE(hit || begin < 1);
    met.from_inside += begin > 1;
    EXPECT_LT(passed_over(body.program, ray, hit ? hit->t : 2 * length(bounds.size())), 1e-4);
    if (!hit) continue;
    ++met.hits;
    EXPECT_EQ(hit->t, together[i]->t);
    EXPECT_EQ(hit->outside, together[i]->outside);
    EXPECT_NEAR(value(body.program, hit->position), 1, 1e-4);
    EXPECT_LT(value(body.program, hit->outside), 1);
    Ray shorter = ray;
    shorter.t_max = begin > 1 ? std::nextafter(hit->t, 0.0) : 0.999 * hit->t;
    EXPECT_FALSE(body.surfaces->occluded(shorter));
  }
}

TEST(Inside, AUnionHasNoSurfaceInItsMembers) {
  Random random(203);
  Met met;
  for (int scene = 0; scene < 8; ++scene) {
    const Affine squeezed = Affine::translate(random.vector(0.3)) * Affine::scale({0.6, 1.2, -0.8});
    const FieldTree tree = tree_of(placed(ball(random.vector(0.5), 0.5)));
    expect_no_surface_in_members(
        random,
        body_of({placed(random_scene(random, {4, contact_alpha(4)}, 3)),
                 placed(random_scene(random, {3, 1.2}, 2), squeezed), placed(ball({0.2, 0, 0}, 0.6))},
                {tree}),
        met);
  }
  std::cout << "  " << met.hits << " hits, " << met.from_inside << " rays from inside\n";
  EXPECT_GT(met.from_inside, 300);
}

// So many that they are found by a hierarchy of their own.
TEST(Inside, AUnionOfManyHasNoSurfaceInItsMembers) {
  Random random(206);
  Met met;
  for (const double far : {0.0, 1e5})
    for (int scene = 0; scene < 3; ++scene) {
      std::vector<PlacedBlend> balls;
      for (int i = 0; i < 60; ++i)
        balls.push_back(placed(ball(Vec3d{far, 0, -far} + random.vector(2), random.between(0.2, 0.8))));
      expect_no_surface_in_members(random, body_of(std::move(balls)), met);
    }
  std::cout << "  " << met.hits << " hits, " << met.from_inside << " rays from inside\n";
  EXPECT_GT(met.from_inside, 300);
}

// What such rays carry tells that they begin outside the member that they leave, not that nothing is in their way.
TEST(Inside, WhatLeavesAMemberIsHiddenByTheOthers) {
  Random random(205);
  int hidden = 0, asked = 0;
  for (int scene = 0; scene < 8; ++scene) {
    const Affine turned = Affine::translate(random.vector(0.5)) * Affine::scale({-0.7, 0.7, 0.7});
    const Body body =
        body_of({placed(random_scene(random, {4, contact_alpha(4)}, 3)), placed(random_scene(random, {3, 1.2}, 3)),
                 placed(random_scene(random, {4, contact_alpha(4)}, 3), turned)});
    for (int i = 0; i < 500; ++i) {
      const Vec3d from = random_direction(random) * 6;
      const auto hit = body.surfaces->first_hit({from, normalize(random.vector(1) - from)});
      if (!hit) continue;
      ASSERT_NE(hit->around.block, nullptr);
      for (int k = 0; k < 4; ++k) {
        const Ray leaving = hit->leaving(normalize(random_direction(random)));
        Ray plain = leaving;
        plain.around = nullptr;
        ++asked;
        hidden += body.surfaces->occluded(leaving);
        EXPECT_EQ(body.surfaces->occluded(leaving), body.surfaces->occluded(plain));
        EXPECT_EQ(body.surfaces->occluded(leaving), body.surfaces->first_hit(leaving).has_value());
      }
    }
  }
  std::cout << "  " << hidden << " of " << asked << " hidden\n";
  EXPECT_GT(hidden, 2000);
  EXPECT_LT(hidden, asked - 2000);
}

// In the valley between two members a step along the normal of one would end in the other.
TEST(Inside, StartsBetweenMembersAreOutside) {
  Random random(204);
  const double radius = 0.5;
  for (const double gap : {-0.2, -1e-3, -1e-6, 0.0, 1e-6}) {
    const Body body =
        body_of({placed(ball({-radius - gap / 2, 0, 0}, radius)), placed(ball({radius + gap / 2, 0, 0}, radius))});
    const double reach = std::sqrt(std::max(0.0, radius * radius - (radius + gap / 2) * (radius + gap / 2)));
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const double around = random.between(0, 6.3);
      const Vec3d crease{0, reach * cos(around), reach * sin(around)};
      const Vec3d to = crease + random_direction(random) * pow(10, random.between(-12, -4));
      const Vec3d from = random_direction(random) * 4;
      const auto hit = body.surfaces->first_hit({from, normalize(to - from)});
      if (!hit) continue;
      ++hits;
      EXPECT_LT(value(body.program, hit->outside), 1) << gap;
    }
    EXPECT_GT(hits, 500) << gap;
  }
}

}  // namespace
}  // namespace marrow::test
