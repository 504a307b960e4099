// Solids under set operations: their hits are those of the whole tree, and what is hard about creases and common faces.
#include "renderer/geometry/boolean_solid.h"

#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "renderer/geometry/embree_surfaces.h"
#include "renderer/geometry/tree_solid.h"
#include "tests/geometry/boolean_scene.h"
#include "tests/trace/random_rays.h"
#include "tests/tree/random_tree.h"

namespace marrow::test {
namespace {

using Record = std::uint32_t;

std::unique_ptr<EmbreeSurfaces> surfaces_of(std::unique_ptr<Solid> solid) {
  std::vector<PlacedSolid> solids;
  solids.push_back({std::move(solid), ObjectId{0}});
  return std::move(*EmbreeSurfaces::make(std::move(solids), {}, "threads=1"));
}

// Blends of some skeletons, and what is done with them.
class Draft {
 public:
  explicit Draft(Random& random) : random_(random), tree_(random) {}
  Record blend(int count = 24) {
    const Setting setting{random_.whole(3, 6), random_.between(0.2, 1.5)};
    return tree_.leaf(BlendLeaf{std::make_shared<BlendField>(random_scene(random_, setting, count))});
  }
  Record leaf(TreeNode node) { return tree_.leaf(std::move(node)); }
  Record plane() {
    return tree_.leaf(Plane{.point = random_.vector(0.5), .normal = normalize(random_.vector(1)), .potential = {}});
  }
  Record ball(double radius) {
    return tree_.leaf(Sphere{.center = random_.vector(1), .radius = radius, .potential = {}});
  }
  Record box() { return tree_.leaf(Box{.center = {}, .size = {2, 1.5, 2}, .rounding = 0, .potential = {}}); }
  Record turned(Record child) {
    const Affine place = Affine::rotate(normalize(random_.vector(1)), random_.between(0, 3)) *
                         Affine::scale({random_.between(0.6, 1.4), 1, random_.between(0.6, 1.4)});
    return tree_.record(AffineWarp{place, place.inverse()}, {child});
  }
  Record without(const std::vector<Record>& of) { return tree_.record(Difference{}, of); }
  Record common(const std::vector<Record>& of) { return tree_.record(Intersection{}, of); }
  Record united(const std::vector<Record>& of) { return tree_.record(CrispUnion{}, of); }
  // Any other operation that changes a body only near another one.
  Record met_by(Record body, Record other) {
    switch (random_.whole(0, 3)) {
      case 0:
        return tree_.record(SoftUnion{.on_first = random_.between(0.3, 1), .on_second = 0.5}, {body, other});
      case 1:
        return tree_.record(SoftDifference{.on_first = random_.between(0.3, 1), .on_second = 1.5}, {body, other});
      case 2:
        return tree_.record(Contact{}, {body, other});
      default:
        return tree_.record(Sum{}, {body, other});
    }
  }
  FieldTree tree() const { return tree_.tree(); }

 private:
  Random& random_;
  RandomTree tree_;
};

constexpr int kinds = 9;
FieldTree some_tree(Random& random, int kind) {
  Draft d(random);
  switch (kind) {
    case 0:
      d.without({d.blend(), d.plane(), d.ball(0.6)});
      break;
    case 1:
      d.without({d.box(), d.turned(d.blend())});
      break;
    case 2:
      d.without({d.turned(d.blend()), d.blend()});
      break;
    case 3:
      d.common({d.united({d.blend(), d.ball(0.5), d.turned(d.blend())}), d.box()});
      break;
    case 4:
      d.turned(d.without({d.common({d.blend(), d.ball(1.5)}), d.without({d.ball(0.8), d.ball(0.8)})}));
      break;
    case 5:
      d.common({d.without({d.ball(1.5), d.without({d.blend(), d.plane()})}), d.blend()});
      break;
    case 6:
      d.met_by(d.blend(), d.ball(0.4));
      break;
    case 7:
      d.without({d.met_by(d.turned(d.blend()), d.ball(0.3)), d.plane()});
      break;
    default:
      d.turned(d.met_by(d.without({d.blend(), d.ball(0.3)}), d.ball(0.3)));
  }
  return d.tree();
}

struct Scene {
  FieldTree tree;
  std::unique_ptr<BooleanSolid> solid;
};

// One whose blends are operands: another body may be too near to most of a blend.
Scene scene(Random& random, int kind) {
  for (;;) {
    FieldTree tree = some_tree(random, kind);
    if (auto solid = boolean_solid_of(tree, 8, MaterialId{})) return {std::move(tree), std::move(solid)};
  }
}

Ray ray_at(Random& random, double distance) {
  const Vec3d from = random_direction(random) * distance;
  return {from, normalize(random.vector(1.2) - from)};
}

TEST(BooleanSolid, IsMetWhereTheTreeIs) {
  Random random(401);
  int hits = 0, differ = 0, inside = 0, starts_inside = 0;
  for (int i_scene = 0; i_scene < 2 * kinds; ++i_scene) {
    auto [tree, solid] = scene(random, i_scene % kinds);
    const auto surfaces = surfaces_of(std::move(solid));
    const auto general = surfaces_of(std::move(*TreeSolid::make(tree, MaterialId{})));
    for (int i = 0; i < 400; ++i) {
      if (i == 200) surfaces->refine();
      const Ray ray = ray_at(random, i % 4 == 0 ? random.between(0, 1) : 6);
      inside += value(tree, ray.origin) > 1;
      const auto hit = surfaces->first_hit(ray), expected = general->first_hit(ray);
      hits += expected.has_value();
      const bool same = hit.has_value() == expected.has_value() &&
                        (!hit || (std::fabs(hit->t - expected->t) < 1e-4 && dot(hit->normal, expected->normal) > 0.99));
      // What is less deep than the traced field is off may be met or not.
      const bool hardly = (hit && std::fabs(value(tree, hit->position) - 1) > 1e-5) ||
                          (expected && value(tree, ray.at(expected->t + 1e-4)) > 1 + 1e-4);
      differ += !same && hardly;
      starts_inside += hit && !(value(tree, hit->outside) < 1);
    }
  }
  std::cout << "  " << hits << " hits, " << inside << " from inside\n";
  EXPECT_GT(hits, 4000);
  EXPECT_GT(inside, 300);
  EXPECT_EQ(differ, 0);
  EXPECT_EQ(starts_inside, 0);
}

// From one side to the other each crossing leads to the other side: what one ray finds, the next ones go on from.
TEST(BooleanSolid, IsCrossedAnEvenNumberOfTimes) {
  Random random(402);
  int lines = 0, odd = 0;
  for (int i_scene = 0; i_scene < 2 * kinds; ++i_scene) {
    auto [tree, solid] = scene(random, i_scene % kinds);
    const auto surfaces = surfaces_of(std::move(solid));
    for (int i = 0; i < 200; ++i) {
      Ray ray = ray_at(random, 6);
      int crossings = 0;
      while (const auto hit = surfaces->first_hit(ray)) {
        ++crossings;
        // A little beyond, by more than traced fields are off.
        ray.t_min = hit->t + 3e-5;
      }
      lines += crossings > 0;
      odd += crossings % 2;
    }
  }
  std::cout << "  " << lines << " lines\n";
  EXPECT_GT(lines, 1200);
  EXPECT_LE(odd, lines / 500);  // through edges that are less than 3e-5 thick
}

// Rounding makes a crossing at every other place of a face in which a ray runs.
TEST(BooleanSolid, EndsRaysThatRunInAFace) {
  Random random(403);
  const Vec3d point = random.vector(0.3);
  const UnitVec3 normal = normalize(random.vector(1));
  Draft d(random);
  d.without({d.blend(), d.leaf(Plane{.point = point, .normal = normal, .potential = {}})});
  const auto surfaces = surfaces_of(boolean_solid_of(d.tree(), 8, MaterialId{}));
  const Frame frame = Frame::around(normal);
  std::uint64_t most = 0;
  for (int i = 0; i < 300; ++i) {
    const auto in_plane = [&](double size) {
      return frame.to_world({random.between(-size, size), random.between(-size, size), 0});
    };
    RayRecord record;
    surfaces->first_hit({point + in_plane(3), normalize(in_plane(1))}, record);
    most = std::max<std::uint64_t>(most, record.evaluations);
  }
  std::cout << "  " << most << " evaluations at most\n";
  EXPECT_LT(most, 200'000);
}

// Both have the ball's surface, and neither may take the other to be in front of it, however far the camera.
TEST(BooleanSolid, HasFacesThatItsOperandsHaveInCommon) {
  Random random(404);
  Draft d(random);
  const Record ball = d.ball(0.9), blend = d.blend();
  const FieldTree tree = [&] {
    d.united({blend, d.common({ball, d.without({ball, d.ball(0.5)})})});
    return d.tree();
  }();
  const auto surfaces = surfaces_of(boolean_solid_of(tree, 8, MaterialId{}));
  const auto general = surfaces_of(std::move(*TreeSolid::make(tree, MaterialId{})));
  int hits = 0, differ = 0;
  for (int i = 0; i < 1500; ++i) {
    const Ray ray = ray_at(random, i % 2 == 0 ? 6 : 1e5);
    const auto hit = surfaces->first_hit(ray), expected = general->first_hit(ray);
    hits += expected.has_value();
    differ += hit.has_value() != expected.has_value() || (hit && std::fabs(hit->t - expected->t) > 1e-4);
  }
  std::cout << "  " << hits << " hits\n";
  EXPECT_GT(hits, 500);
  EXPECT_LE(differ, 1);  // at a silhouette
}

TEST(BooleanSolid, KnowsClearSides) {
  Random random(405);
  int known = 0;
  for (int kind = 0; kind < kinds; ++kind) {
    const auto [tree, solid] = scene(random, kind);
    for (int i = 0; i < 2000; ++i) {
      const Vec3d p = random.vector(1.5);
      const Side side = solid->clear_side(p);
      known += side != Side::Unknown;
      const double f = value(tree, p);
      EXPECT_EQ(solid->value(p), f);
      EXPECT_TRUE(side == Side::Unknown || (side == Side::Inside ? f > 1 : f < 1)) << f;
    }
  }
  EXPECT_GT(known, 9000);
}

}  // namespace
}  // namespace marrow::test
