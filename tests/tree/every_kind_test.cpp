// Every kind of node, with random parameters in small trees, keeps the laws of fields; a new kind needs no line here.
#include <string>

#include <gtest/gtest.h>

#include "tests/tree/kinds_of.h"
#include "tests/tree/laws_in_doubles.h"
#include "tests/tree/small_tree.h"

namespace marrow::test {
namespace {

template <class Kind>
class EveryKind : public testing::Test {
 protected:
  Random random_{20260101};

  /// Calls law(tree) with ever new trees until it says stop or a check failed.
  template <class Law>
  void for_trees(const Law& law) {
    for (std::uint64_t round = 0; !this->HasFailure(); ++round) {
      SCOPED_TRACE("tree " + std::to_string(round));
      if (!law(SmallTree<Kind>::random(random_))) return;
    }
  }
};
// Those of scenes, and what compile() makes of placements and unions; blends have tests of their own.
using Kinds = tree::Extended<AnyNode, PointLeaf, AffineWarp, CrispUnion>::type;
TYPED_TEST_SUITE(EveryKind, KindsOf<Kinds>::type, NameOfKind);

TYPED_TEST(EveryKind, EnclosuresHoldValuesAndSlopes) {
  Checks checks;
  this->for_trees([&](const auto& tree) {
    for (int i = 0; i < 4; ++i) {
      expect_enclosures(tree, random_box(tree.eventful_point(this->random_), this->random_), 6, this->random_, checks);
      expect_ray_enclosures(tree, tree.eventful_point(this->random_), 3, this->random_, checks);
    }
    return checks.enclosures < wanted_checks();
  });
}

TYPED_TEST(EveryKind, DerivativesAreThoseOfDifferences) {
  Checks checks;
  this->for_trees([&](const auto& tree) {
    for (int i = 0; i < 8; ++i) {
      const Vec3d p = tree.eventful_point(this->random_);
      expect_gradient(tree, p, checks);
      if (i % 2 == 0) expect_hessian(tree, p, checks);
    }
    return checks.slopes < wanted_checks();
  });
  std::cout << "  " << checks.slopes << " slopes, " << checks.rough_slopes << " at kinks; " << checks.curvatures
            << " curvatures, " << checks.rough_curvatures << " at kinks\n";
  EXPECT_LT(checks.rough_slopes, checks.slopes / 2);  // those of sharp operators turn fast where fields are tiny
  EXPECT_LT(checks.rough_curvatures, checks.curvatures / 4);
}

TYPED_TEST(EveryKind, IsNothingOutsideItsSupport) {
  constexpr bool is_primitive = SmallTree<TypeParam>::is_primitive;
  int trees = 0;
  this->for_trees([&](const auto& tree) {
    const Box3 support = tree.support();
    for (std::size_t face = 0; face < 6; ++face) {
      const std::size_t axis = face / 2;
      const bool above = face % 2;
      if (!std::isfinite((above ? support.upper : support.lower)[axis])) continue;
      for (const double thickness : {1e-6, 1.0}) {
        const auto wrong = find_something(tree, slab(support, axis, above, thickness), 60);
        EXPECT_FALSE(wrong) << "something at " << wrong->x << ", " << wrong->y << ", " << wrong->z;
      }
      const double shallow = -0.02 * (support.upper[axis] - support.lower[axis]);
      if (is_primitive && std::isfinite(shallow)) {
        EXPECT_TRUE(find_something(tree, slab(support, axis, above, shallow), 2000)) << "loose at face " << face;
      }
    }
    return ++trees < 30;
  });
}

/// Values of children as they come: 0, around 1, up to 2.
std::vector<double> child_values(std::size_t count, Random& random) {
  std::vector<double> f(count, 0);
  for (double& x : f)
    if (random.between(0, 1) < 0.7) x = random.between(0, 2);
  return f;
}

TYPED_TEST(EveryKind, IgnoresZerosWhereItSaysSo) {
  if constexpr (requires { TypeParam::ignores_zeros; }) {
    for (int trial = 0; trial < 1000; ++trial) {
      const std::vector<double> all = child_values(static_cast<std::size_t>(this->random_.whole(1, 5)), this->random_);
      if (all.size() < info_of_kind<TypeParam>().min_children) continue;
      const TypeParam node = random_node<TypeParam>(all.size(), this->random_);
      std::vector<double> some;
      for (const double x : all)
        if (x != 0) some.push_back(x);
      if (some.empty()) continue;
      const double expected = node.value(std::span<const double>(all));
      EXPECT_NEAR(node.value(std::span<const double>(some)), expected, 1e-14 * (1 + expected)) << "trial " << trial;
    }
  }
}

TYPED_TEST(EveryKind, StaysBelowALevelWhenItsChildrenDo) {
  if constexpr (SmallTree<TypeParam>::is_operator) {
    for (int trial = 0; trial < 3000; ++trial) {
      const auto count = std::max<std::size_t>(info_of_kind<TypeParam>().min_children,
                                               static_cast<std::size_t>(this->random_.whole(1, 5)));
      if (count > info_of_kind<TypeParam>().max_children) continue;
      const TypeParam node = random_node<TypeParam>(count, this->random_);
      const double level = this->random_.between(0.05, 1.5);
      double child_level = level;
      if constexpr (requires { node.child_level(level, count); }) child_level = node.child_level(level, count);
      std::vector<double> f(count);
      for (double& x : f) x = child_level * std::min(1.0, this->random_.between(0, 1.3)) * (1 - 1e-12);
      EXPECT_LT(node.value(std::span<const double>(f)), level * (1 + 1e-12)) << "trial " << trial;
    }
  }
}

}  // namespace
}  // namespace marrow::test
