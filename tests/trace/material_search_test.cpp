// The material of a place, by bounds of groups, is the one that has most of the field there.
#include "field/trace/material_search.h"

#include <algorithm>
#include <functional>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>

#include "field/trace/sources/pieces.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

constexpr double critical_field = 8;  // only tells pieces how near to them all is inside

// Of some materials, and now and then the object's own: in turns, at random, or one for each half of the scene.
BlendField with_materials(BlendField blend, Random& random) {
  const int count = random.whole(2, 5), order = random.whole(0, 2);
  const auto set = [&](auto& list, const auto& at) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const int number = order == 0   ? static_cast<int>(i) % count
                         : order == 1 ? random.whole(0, count - 1)
                                      : at(list.skeletons[i]).x > 0;
      list.materials.push_back(number == 0 ? MaterialId{} : MaterialId{static_cast<std::size_t>(number + 3)});
    }
  };
  set(blend.points, [](const PointSkeleton& s) { return s.at; });
  set(blend.segments, [](const SegmentSkeleton& s) { return s.from; });
  return blend;
}

// Anywhere, near a skeleton, on one, or far away.
Vec3d place(Random& random, const BlendField& blend) {
  const int kind = random.whole(0, 9);
  if (kind < 4) return random.vector(2);
  if (kind == 4) return random.vector(100);
  const SegmentSkeleton& s =
      blend.segments.skeletons[static_cast<std::size_t>(random.whole(0, static_cast<int>(blend.segments.size()) - 1))];
  const Vec3d on = lerp(s.from, s.to, random.between(-0.1, 1.1));
  return kind == 5 && !blend.points.empty() ? blend.points.skeletons[0].at : on + random.vector(s.radius_from);
}

TEST(MaterialSearch, FindsTheOneWithTheLargestShare) {
  Random random(201);
  int told = 0, ties = 0;
  for (const int n : {3, 4, 5, 8, 14})
    for (const int count : {3, 12, 60, 400}) {
      const BlendField blend = with_materials(random_scene(random, {.degree = n}, count), random);
      const SourceTree tree(PieceCutter(n, critical_field).cut(blend), n);
      const MaterialSearch search(blend, tree);
      for (int i = 0; i < 300; ++i) {
        const Vec3d p = place(random, blend);
        MaterialWeights all = material_weights(blend, p);
        std::ranges::sort(all, std::ranges::greater{}, &MaterialWeight::weight);
        if (all.size() > 1 && all[0].weight < all[1].weight * (1 + 1e-9)) {
          ++ties;
          continue;
        }
        ++told;
        EXPECT_EQ(search.at(p), all.front().material) << "n=" << n << " of " << count;
      }
    }
  std::cout << "  " << told << " places, " << ties << " ties\n";
  EXPECT_LT(ties, 100);
}

TEST(MaterialSearch, KnowsOneMaterialWithoutASearch) {
  Random random(202);
  BlendField blend = random_scene(random, {}, 9);
  const SourceTree tree(PieceCutter(4, critical_field).cut(blend), 4);
  EXPECT_FALSE(MaterialSearch(blend, tree).at({0, 0, 0}).valid());
  for (auto* materials : {&blend.points.materials, &blend.segments.materials})
    materials->assign(materials == &blend.points.materials ? blend.points.size() : blend.segments.size(),
                      MaterialId{7});
  EXPECT_EQ(MaterialSearch(blend, tree).at({0, 0, 0}), MaterialId{7});
}

// Fields that leave the range of double, and places that are none, end the search too.
TEST(MaterialSearch, EndsWhateverThePlace) {
  Random random(203);
  const BlendField blend = with_materials(random_scene(random, {.degree = 20}, 200), random);
  const SourceTree tree(PieceCutter(20, critical_field).cut(blend), 20);
  const MaterialSearch search(blend, tree);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3d& p : {Vec3d{1e30, 0, 0}, Vec3d{nan, 0, 0}, blend.points.skeletons[0].at,
                         blend.segments.skeletons[0].from + Vec3d{1e-300, 0, 0}})
    search.at(p);
  EXPECT_EQ(search.at(blend.points.skeletons[0].at), blend.points.material(0));
}

}  // namespace
}  // namespace marrow::test
