// Trees of every kind of node, nested anyhow: enclosures, derivatives, restriction to a box, and who contributed.
#include "tests/tree/random_tree.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "field/tree/machine.h"
#include "tests/tree/kinds_of.h"
#include "tests/tree/laws_in_doubles.h"

namespace marrow::test {
namespace {

struct Whole {
  const FieldTree& tree;
  template <Number X>
  X value(const Vec3<X>& p) const {
    return marrow::value(tree, p);
  }
  double rounding() const { return 1e-9; }
};

template <class Law>
void for_random_trees(std::uint64_t seed, const Law& law) {
  Random random(seed);
  for (int round = 0; !testing::Test::HasFailure(); ++round) {
    SCOPED_TRACE("tree " + std::to_string(round));
    const FieldTree tree = RandomTree(random).make(random.whole(1, 4));
    if (!law(tree, random)) return;
  }
}

TEST(RandomTree, EnclosuresHoldValuesAndSlopes) {
  Checks checks;
  for_random_trees(20260104, [&](const FieldTree& tree, Random& random) {
    for (int i = 0; i < 10 && !testing::Test::HasFailure(); ++i) {
      expect_enclosures_in_doubles(Whole{tree}, random_box(random.vector(2), random), random, checks);
      expect_ray_enclosures_in_doubles(Whole{tree}, random.vector(2), random, checks);
    }
    return checks.enclosures < wanted_checks();
  });
  std::cout << "  " << checks.enclosures << " enclosures\n";
}

TEST(RandomTree, DerivativesAreThoseOfDifferences) {
  Checks checks;
  for_random_trees(20260105, [&](const FieldTree& tree, Random& random) {
    for (int i = 0; i < 10 && !testing::Test::HasFailure(); ++i)
      expect_derivatives_in_doubles(Whole{tree}, random.vector(2), true, checks);
    return checks.slopes < wanted_checks();
  });
  std::cout << "  " << checks.slopes << " slopes, " << checks.rough_slopes << " at kinks; " << checks.curvatures
            << " curvatures, " << checks.rough_curvatures << " at kinks\n";
  EXPECT_LT(checks.rough_slopes, checks.slopes / 10);
}

TEST(RandomTree, IsTheSameInABoxWithLess) {
  int checked = 0;
  for_random_trees(20260106, [&](const FieldTree& tree, Random& random) {
    const Box3 box = random_box(random.vector(2), random);
    const FieldTree less = restricted(tree, box);
    for (int i = 0; i < 5; ++i) {
      const Vec3d p = point_in(box, random);
      const double whole = value(tree, p), part = less.records().empty() ? 0 : value(less, p);
      EXPECT_TRUE(whole == part || std::fabs(whole - part) <= 1e-13 * (1 + std::fabs(whole))) << whole << ' ' << part;
    }
    return ++checked < 400;
  });
}

TEST(RandomTree, IsBelowOneOutsideItsSurfaceBounds) {
  int checked = 0;
  for_random_trees(20260107, [&](const FieldTree& tree, Random& random) {
    const Box3 bounds = surface_bounds(tree);
    for (int i = 0; i < 20; ++i) {
      const Vec3d p = random.vector(6);
      if (!bounds.contains(p)) { EXPECT_LT(value(tree, p), 1); }
    }
    return ++checked < 300;
  });
}

TEST(RandomTree, WeightsOfItsLeavesSumToOne) {
  int checked = 0, many = 0;
  for_random_trees(20260108, [&](const FieldTree& tree, Random& random) {
    const Vec3d p = random.vector(1.5);
    const std::vector<LeafWeight> leaves = leaf_weights(tree, p);
    EXPECT_EQ(leaves.empty(), !(value(tree, p) > 0));
    double sum = 0;
    for (const LeafWeight& leaf : leaves) {
      EXPECT_GT(leaf.weight, 0);
      EXPECT_EQ(leaf.leaf->child_count, 0u);
      sum += leaf.weight;
    }
    if (!leaves.empty()) { EXPECT_NEAR(sum, 1, 1e-12); }
    checked += !leaves.empty();
    many += leaves.size() > 1;
    return checked < 600;
  });
  EXPECT_GT(many, 60);
}

template <class Kind>
class LeafWeights : public testing::Test {};
using Kinds = tree::Extended<AnyNode, AffineWarp, CrispUnion>::type;
TYPED_TEST_SUITE(LeafWeights, KindsOf<Kinds>::type, NameOfKind);

// w_i = f_i |dF/df_i|, normalised, against differences of the operator.
TYPED_TEST(LeafWeights, AreContributions) {
  Random random(20260109);
  int checked = 0;
  constexpr NodeInfo info = info_of_kind<TypeParam>();
  for (int round = 0; round < 2000 && checked < 100 && !this->HasFailure(); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const auto count = static_cast<std::size_t>(random.whole(
        static_cast<int>(info.min_children), static_cast<int>(std::min(info.max_children, info.min_children + 2))));
    const FieldTree tree = RandomTree(random).over_balls<TypeParam>(count);
    const Vec3d p = random.vector(1.5);
    const std::vector<LeafWeight> leaves = leaf_weights(tree, p);
    if (leaves.empty()) continue;
    if constexpr (!tree::Operator<TypeParam, double>) {
      ASSERT_EQ(leaves.size(), 1u);
      EXPECT_EQ(leaves[0].weight, 1);
      ++checked;
    } else {
      const auto& node = std::get<TypeParam>(tree.node(tree.records()[tree.root()]));
      std::vector<double> f, share(count);
      for (std::uint32_t c : tree.children(tree.records()[tree.root()]))
        f.push_back(std::get<Sphere>(tree.node(tree.records()[c])).value(p));
      if constexpr (requires { node.owner(std::span<const double>(f)); }) {  // does not mix
        const std::size_t owner = node.owner(std::span<const double>(f));
        if (!(f[owner] > 0)) continue;  // the value is but a bulge, far below a surface
        ASSERT_EQ(leaves.size(), 1u);
        EXPECT_EQ(leaves[0].leaf, &tree.records()[tree.children(tree.records()[tree.root()])[owner]]);
        ++checked;
        continue;
      }
      double total = 0;
      bool smooth = true;
      for (std::size_t i = 0; i < count; ++i) {
        const auto with = [&](double h) {
          std::vector<double> g = f;
          g[i] += h;
          return node.value(std::span<const double>(g));
        };
        constexpr double h = 1e-6;
        if (f[i] < 1e-3) {
          smooth = smooth && f[i] == 0;
          continue;
        }
        const double ahead = (with(h) - with(0)) / h, behind = (with(0) - with(-h)) / h;
        smooth = smooth && std::fabs(ahead - behind) < 1e-4;
        total += share[i] = f[i] * std::fabs((ahead + behind) / 2);
      }
      if (!smooth || !(total > 0.01)) continue;
      for (std::size_t i = 0; i < count; ++i) {
        double weight = 0;
        for (const LeafWeight& leaf : leaves)
          if (leaf.leaf == &tree.records()[tree.children(tree.records()[tree.root()])[i]]) weight = leaf.weight;
        EXPECT_NEAR(weight, share[i] / total, 1e-2) << "child " << i;
      }
      ++checked;
    }
  }
  EXPECT_GE(checked, 50);
}

// Leaves of one material count together; the largest share gives the material.
TEST(RandomTree, MaterialWeightsAreThoseOfTheLeaves) {
  int checked = 0;
  for_random_trees(20260110, [&](const FieldTree& tree, Random& random) {
    const Vec3d p = random.vector(1.5);
    const std::vector<LeafWeight> leaves = leaf_weights(tree, p);
    const MaterialWeights materials = material_weights(tree, p);
    EXPECT_EQ(materials.empty(), leaves.empty());
    double sum = 0, most = 0;
    for (const MaterialWeight& w : materials) {
      double of_leaves = 0;
      bool blends = false;
      for (const LeafWeight& leaf : leaves) {
        blends = blends || std::holds_alternative<BlendLeaf>(tree.node(*leaf.leaf));
        if (leaf.leaf->material == w.material) of_leaves += leaf.weight;
      }
      if (!blends) { EXPECT_NEAR(w.weight, of_leaves, 1e-12); }
      sum += w.weight;
      most = std::max(most, w.weight);
    }
    if (leaves.empty()) return true;
    EXPECT_NEAR(sum, 1, 1e-12);
    const MaterialId chosen = strongest_material(tree, p);
    EXPECT_TRUE(std::any_of(materials.begin(), materials.end(),
                            [&](const auto& w) { return w.material == chosen && w.weight == most; }));
    return ++checked < 300;
  });
}

}  // namespace
}  // namespace marrow::test
