// Blending along a skeleton: what is linked adds up, what is not meets as a union.
#include "field/tree/nodes/restricted_blend.h"

#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

using test::field_of;

std::vector<std::vector<double>> chain(std::size_t n) {
  std::vector<std::vector<double>> links;
  for (std::size_t i = 1; i < n; ++i) links.push_back({double(i - 1), double(i)});
  return links;
}

TEST(RestrictedBlend, AddsWhatIsLinked) {
  const RestrictedBlend blend{.threshold = 0.1, .neighbours = {}};
  EXPECT_NEAR(field_of(blend, {0.3, 0.5, 0.2, 0.1}), 1.1, 1e-15);
}

TEST(RestrictedBlend, FoldsDoNotBlend) {
  const RestrictedBlend blend{.threshold = 0.1, .neighbours = {}};
  EXPECT_NEAR(field_of(blend, {0.4, 0.3, 0, 0, 0.2, 0.6}), 0.8, 1e-15);
}

// A chain written as a graph is the same; so is a graph whatever the order of its pairs.
TEST(RestrictedBlend, ChainAndGraphAgree) {
  test::Random random(8);
  const RestrictedBlend line{.threshold = 0.3, .neighbours = {}}, graph{.threshold = 0.3, .neighbours = chain(7)};
  RestrictedBlend reversed = graph;
  std::reverse(reversed.neighbours.begin(), reversed.neighbours.end());
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> f(7);
    for (double& x : f) x = std::max(0.0, random.between(-0.2, 0.6));
    EXPECT_NEAR(field_of(line, f), field_of(graph, f), 1e-14) << "seed 8 round " << i;
    EXPECT_NEAR(field_of(reversed, f), field_of(graph, f), 1e-14) << "seed 8 round " << i;
  }
}

// A ring and a fork; a step is never more than a field changes, times the children that can pass it on.
TEST(RestrictedBlend, GraphsAreContinuous) {
  test::Random random(9);
  const RestrictedBlend ring{.threshold = 0.2, .neighbours = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {3, 4}}};
  EXPECT_NEAR(field_of(ring, {0.4, 0, 0.3, 0.3, 0}), 1.0, 1e-15);  // by way of 3
  for (int i = 0; i < 2000; ++i) {
    std::vector<double> f(5), g;
    for (double& x : f) x = std::max(0.0, random.between(-0.2, 0.5));
    g = f;
    g[static_cast<std::size_t>(i) % 5] += 1e-7;
    EXPECT_NEAR(field_of(ring, f), field_of(ring, g), 1e-5) << "seed 9 round " << i;
  }
}

TEST(RestrictedBlend, Laws) {
  test::expect_lawful_operator(RestrictedBlend{}, 4, 31);
  test::expect_lawful_operator(RestrictedBlend{.threshold = 0.8, .neighbours = {}}, 5, 32);
  test::expect_lawful_operator(
      RestrictedBlend{.threshold = 0.8, .neighbours = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {3, 4}}}, 5, 33);
  test::expect_child_level(RestrictedBlend{}, 4, 34);
}

TEST(RestrictedBlend, RefusesPairsThatAreNone) {
  EXPECT_EQ((RestrictedBlend{0.1, {{0, 1}, {1, 2}}}.problem(3)), "");
  EXPECT_NE((RestrictedBlend{0.1, {{0, 1, 2}}}.problem(3)), "");
  EXPECT_NE((RestrictedBlend{0.1, {{0, 3}}}.problem(3)), "");
  EXPECT_NE((RestrictedBlend{0.1, {{0.5, 1}}}.problem(3)), "");
  EXPECT_NE((RestrictedBlend{0.1, {{1, 1}}}.problem(3)), "");
}

}  // namespace
}  // namespace marrow
