// Groups of sources: they hold what they say, and stand for their pieces within the errors they state.
#include "field/trace/sources/source_tree.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "field/skeleton/skeletons.h"
#include "field/trace/cells/upper_cubes.h"
#include "field/trace/sources/quadrature.h"
#include "tests/trace/far_value.h"
#include "tests/trace/stage.h"

namespace marrow::test {
namespace {

// Many small skeletons in a few clumps, so that groups of all sizes are far from somewhere.
BlendField clumps(Random& random, int degree, int count) {
  BlendField blend;
  blend.degree = degree;
  Vec3d clump;
  for (int i = 0; i < count; ++i) {
    if (i % 40 == 0) clump = random.vector(8);
    const Vec3d at = clump + random.vector(0.6);
    const double thick = random.between(0.05, 0.15);
    if (i % 4 == 3) blend.points.add({at, thick}, {});
    else blend.segments.add({at, at + random.vector(0.3), thick, i % 3 ? thick : random.between(0.05, 0.15)}, {});
  }
  return blend;
}

SourceTree tree_of(const BlendField& blend) {
  return SourceTree(PieceCutter(blend.degree, 2.0).cut(blend), blend.degree);
}

// Sources of most segments count more towards one end.
SourceTree leaning_tree_of(const BlendField& blend, Random& random) {
  std::vector<Piece> pieces = PieceCutter(blend.degree, 2.0).cut(blend);
  for (Piece& p : pieces) {
    const double from = random.between(0, 1), to = random.between(0, 1) < 0.2 ? 0 : random.between(0, 1);
    p = p.scaled(from, p.is_point() ? from : to);
  }
  return SourceTree(std::move(pieces), blend.degree);
}

void for_each_node(const SourceTree& tree, const std::function<void(const SourceNode&)>& visit) {
  std::vector<SourceRef> open(tree.roots().begin(), tree.roots().end());
  while (!open.empty()) {
    const SourceRef here = open.back();
    open.pop_back();
    const SourceNode& n = tree.node(here.index());
    visit(n);
    if (n.is_leaf()) continue;
    open.push_back(SourceRef::node(here.index() + 1));
    open.push_back(SourceRef::node(n.right));
  }
}

TEST(SourceTree, HoldsEveryPieceOnceInsideItsBalls) {
  Random random(61);
  for (const int count : {1, 7, 8, 9, 400}) {
    const SourceTree tree = tree_of(clumps(random, 4, count));
    std::vector<int> seen(tree.pieces().size(), 0);
    for_each_node(tree, [&](const SourceNode& n) {
      for (std::uint32_t i = n.begin; i < n.end; ++i) {
        const Piece& p = tree.piece(i);
        EXPECT_EQ(p.is_point(), n.is_point);
        EXPECT_LE(length(p.from - n.center), n.radius * (1 + 1e-12));
        EXPECT_LE(length(p.to - n.center), n.radius * (1 + 1e-12));
        if (n.is_leaf()) ++seen[i];
      }
    });
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  }
}

// Against sums over many short stretches of every piece.
TEST(SourceTree, MomentsAreThoseOfThePieces) {
  Random random(62);
  int trees = 0;
  for (const int degree : {3, 4, 7, 20, 5, 20}) {
    const bool leans = ++trees > 4;
    const BlendField blend = clumps(random, degree, 60);
    const SourceTree tree = leans ? leaning_tree_of(blend, random) : tree_of(blend);
    for_each_node(tree, [&](const SourceNode& n) {
      double mass = 0, spread = 0, tau_mass = 0, tau_spread = 0;
      Vec3d first, tau_shift;
      for (std::uint32_t i = n.begin; i < n.end; ++i) {
        const Piece& p = tree.piece(i);
        const int steps = p.is_point() ? 1 : 400;
        for (int k = 0; k < steps; ++k) {
          const double s = (k + 0.5) / steps, tau = p.radius_from + (p.radius_to - p.radius_from) * s;
          const double w = p.mass * p.weight_at(s) * integer_power(tau / p.radius, degree - 1) / steps;
          const Vec3d at = lerp(p.from, p.to, s) - n.center;
          mass += w;
          first += at * w;
          spread += w * length_squared(at);
          tau_mass += w * tau;
          tau_shift += at * (w * tau);
          tau_spread += w * tau * length_squared(at);
        }
      }
      const double size = std::max(n.radius, 1e-3);
      EXPECT_NEAR(n.mass, mass, 1e-4 * mass);
      EXPECT_LT(length(first), 1e-4 * mass * size);
      EXPECT_NEAR(n.spread, spread, 1e-4 * mass * size * size);
      EXPECT_NEAR(n.tau_mass, tau_mass, 1e-4 * tau_mass);
      EXPECT_LT(length(n.tau_shift - tau_shift), 1e-4 * tau_mass * size);
      EXPECT_NEAR(n.tau_spread, tau_spread, 1e-4 * tau_mass * size * size);
    });
  }
}

// By rules of 16 nodes on short parts, as what is asked is far away.
FarValue exact_of_leaning(const Piece& piece, const Vec3d& p, int n) {
  const GaussNodes rule = gauss_legendre(16);
  constexpr int parts = 8;
  FarValue sum;
  for (int part = 0; part < parts; ++part)
    for (std::size_t k = 0; k < rule.positions.size(); ++k) {
      const double s = (part + rule.positions[k]) / parts;
      const Vec3d v = p - lerp(piece.from, piece.to, s);
      const double tau = std::lerp(piece.radius_from, piece.radius_to, s), d = length(v);
      const double weight = piece.mass / integer_power(piece.radius, n - 1) * piece.weight_at(s) * rule.weights[k];
      const double field = weight / parts * integer_power(tau, n - 1) / integer_power(d, n);
      sum.f += field;
      sum.g += v * (-n * field * tau / (d * d));
    }
  return sum;
}

FarValue exact(const Piece& piece, const Vec3d& p, int degree) {
  if (piece.lean != 0) return exact_of_leaning(piece, p, degree);
  const SkeletonSample s = piece.is_point()
                               ? point_field<Derivatives::ScaleInvariant>({piece.from, piece.radius}, p, degree)
                               : segment_field<Derivatives::ScaleInvariant>(
                                     {piece.from, piece.to, piece.radius_from, piece.radius_to}, p, degree);
  return {piece.factor * s.value, piece.factor * s.si_gradient};
}

// All pieces but those that are listed, by themselves or in a group.
std::vector<bool> pieces_without(const SourceTree& tree, const std::vector<SourceRef>& near) {
  std::vector<bool> left(tree.pieces().size(), true);
  for (const SourceRef ref : near) {
    const bool piece = ref.is_piece();
    const std::uint32_t begin = piece ? ref.index() : tree.node(ref.index()).begin,
                        end = piece ? begin + 1 : tree.node(ref.index()).end;
    for (std::uint32_t i = begin; i < end; ++i) left[i] = false;
  }
  return left;
}

FarValue sum_of(const SourceTree& tree, const std::vector<bool>& pieces, const Vec3d& p, int degree) {
  FarValue sum;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!pieces[i]) continue;
    const FarValue v = exact(tree.pieces()[i], p, degree);
    sum.f += v.f;
    sum.g += v.g;
  }
  return sum;
}

// What a split folds away is what it leaves out of the list, to the error it states; groups and pieces alike.
TEST(SourceTree, SplitsAreWithinTheirStatedErrors) {
  constexpr int far_degrees[] = {high_far_degree, low_far_degree, highest_far_degree};
  Random random(63);
  double f_use = 0, g_use = 0;
  std::size_t folded = 0, kept_groups = 0;
  for (int round = 0; round < 200; ++round) {
    const int n = random.whole(3, 7);
    const BlendField blend = clumps(random, n, 400);
    const SourceTree tree = round < 150 ? tree_of(blend) : leaning_tree_of(blend, random);
    const NearFar near_far(n, budget_of(round % 2 ? 1e-5 : 2e-2, n), *block_kernels(""), far_degrees[round / 2 % 3]);
    const Vec3d center = random.vector(8);
    const double half = exp(random.between(-4, 1));
    FarField far;
    const auto near = near_far.split(tree, tree.roots(), center, half, round % 3 ? 0.5 : -1, far);
    for (const SourceRef ref : near) kept_groups += !ref.is_piece();
    const std::vector<bool> is_far = pieces_without(tree, near);
    for (int k = 0; k < 10; ++k) {
      Vec3d x = random.vector(1);
      if (k % 2 == 0) x = x / max_component(abs(x));  // on a face
      const FarValue sum = sum_of(tree, is_far, center + x * half, n);
      if (k == 0) folded += static_cast<std::size_t>(std::count(is_far.begin(), is_far.end(), true));
      const FarValue found = value_of(far, x);
      const double f_error = std::fabs(found.f - sum.f), g_error = length(found.g - sum.g);
      ASSERT_LE(f_error, far.f_error) << "n=" << n << " half=" << half;
      ASSERT_LE(g_error, far.gradient_error) << "n=" << n << " half=" << half;
      if (far.f_error > 0) f_use = std::max(f_use, f_error / far.f_error);
      if (far.gradient_error > 0) g_use = std::max(g_use, g_error / far.gradient_error);
    }
  }
  std::cout << "  " << folded << " pieces folded, " << kept_groups << " groups kept; largest error over bound: f "
            << f_use << ", grad_S f " << g_use << '\n';
  EXPECT_GT(folded, 5000U);
  EXPECT_GT(kept_groups, 50U);
}

// Down to a tile, whose errors are then no more than half as large again as if it had asked all sources itself.
TEST(UpperCubes, HandDownWhatTheyFold) {
  Random random(64);
  double f_use = 0, ratio = 0;
  for (int round = 0; round < 60; ++round) {
    const int n = random.whole(3, 7);
    const SourceTree tree = tree_of(clumps(random, n, 400));
    const BlockKernels& kernels = *block_kernels("");
    const NearFar coarse(n, budget_of(2e-2, n), kernels, high_far_degree),
        fine(n, budget_of(1e-5, n), kernels, round % 2 ? high_far_degree : highest_far_degree);
    UpperCubes above(tree, coarse, fine, kernels);
    Vec3d center = random.vector(8);
    double half = exp(random.between(1, 3));
    const UpperCube* cube = &above.add(center, half, nullptr, 0);
    int octant = 0;
    const auto enter_an_octant = [&] {
      octant = random.whole(0, 7);
      center = octant_center(center, half, octant);
      half /= 2;
    };
    for (int level = random.whole(0, 4); level > 0; --level) {
      enter_an_octant();
      cube = &above.add(center, half, cube, octant);
    }
    enter_an_octant();
    const auto seen_by = [&](const NearFar& precision, const KeptSurroundings& parent) {
      return refined(precision, tree, &parent, octant, center, half, largest_fine_group);
    };
    for (const Surroundings& found :
         {seen_by(coarse, above.coarse_around(*cube)), seen_by(fine, above.fine_around(*cube))}) {
      const std::vector<bool> folded = pieces_without(tree, found.near);
      for (int k = 0; k < 5; ++k) {
        const Vec3d x = random.vector(1);
        const FarValue exact_sum = sum_of(tree, folded, center + x * half, n), sum = value_of(found.far, x);
        ASSERT_LE(std::fabs(sum.f - exact_sum.f), found.far.f_error) << "n=" << n << " half=" << half;
        ASSERT_LE(length(sum.g - exact_sum.g), found.far.gradient_error) << "n=" << n << " half=" << half;
        if (found.far.f_error > 0) f_use = std::max(f_use, std::fabs(sum.f - exact_sum.f) / found.far.f_error);
      }
    }
    const double alone = refined(fine, tree, nullptr, 0, center, half, largest_fine_group).far.f_error;
    const double inherited = seen_by(fine, above.fine_around(*cube)).far.f_error;
    if (alone > 10 * fine.budget().field) ratio = std::max(ratio, inherited / alone);
  }
  std::cout << "  largest error over bound: f " << f_use << "; bound over that of a tile by itself: " << ratio << '\n';
  EXPECT_GT(ratio, 0);
  EXPECT_LT(ratio, 1.5);
}

// Without groups each cube would look at every source.
TEST(SourceTree, FarAwayAFewGroupsAreEnough) {
  Random random(64);
  const SourceTree tree = tree_of(clumps(random, 4, 4000));
  const NearFar fine(4, budget_of(1e-5, 4), *block_kernels(""), low_far_degree);
  FarField far;
  EXPECT_TRUE(fine.split(tree, tree.roots(), {300, 0, 0}, 1, -1, far).empty());
  EXPECT_GT(far.f[0], 0);
  // The budget of one group, twice for curves and points, and rounding: one source each.
  EXPECT_LT(far.f_error, 3 * budget_of(1e-5, 4).field);
}

}  // namespace
}  // namespace marrow::test
