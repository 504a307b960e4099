// De Groot's better blending: reference values, his three solutions, laws.
#include "field/tree/nodes/weighted_blend.h"

#include <nlohmann/json.hpp>

#include "tests/field/reference_values.h"
#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

using nlohmann::json;
using test::field_of;

// Scaled to a surface at 1: fields, k and g are lengths of the same scale as c.
TEST(WeightedBlend, ReferenceValues) {
  int checked = 0;
  for (const json& e : test::reference_values().at("older_papers")) {
    if (e.at("what") != "blobtree_gk_dij") continue;
    ++checked;
    const double c = e.at("c"), k = e.at("k"), t = e.at("t"), f = e.at("f_j"), w = e.at("w_ij");
    EXPECT_NEAR(c * narrowed(t / c, 1 - k / c), e.at("g_k"), 1e-14) << e.at("id");
    EXPECT_NEAR(kept_width(f / c, w), e.at("d_ij"), 1e-14) << e.at("id");
  }
  EXPECT_EQ(checked, 40);
}

TEST(WeightedBlend, NarrowedKeepsTheSurfaceAndRises) {
  for (const double width : {1.0, 0.5, 0.01}) {
    EXPECT_EQ(narrowed(0.0, width), 0);
    EXPECT_EQ(narrowed(1 - width, width), 0);
    EXPECT_EQ(narrowed(1.0, width), 1);
    EXPECT_EQ(narrowed(1 + width, width), 2);
    EXPECT_EQ(narrowed(7.0, width), 2);
    double last = 0;
    for (double t = 0; t < 2.5; t += 1e-3) {
      const double g = narrowed(t, width);
      EXPECT_GE(g, last);
      EXPECT_NEAR(narrowed(2 - t, width), 2 - g, 1e-12);
      last = g;
    }
  }
}

TEST(WeightedBlend, UnitWeightsAreSquares) {
  const WeightedBlend blend{.solution = LocalWidths{}, .weights = {}};
  EXPECT_NEAR(field_of(blend, {0.3, 0.5, 0.7}), 0.09 + 0.25 + 0.49, 1e-15);
}

TEST(WeightedBlend, SolutionsAgainstTheirFormulas) {
  const std::vector<std::vector<double>> w{{0.9, 0.3, 0.6}, {0.5, 1, 0.2}, {0.8, 0.7, 0.4}};
  const std::vector<double> f{0.8, 0.55, 0.9};
  double separate = 0, pairs = 0, local = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    separate += narrowed(f[i], w[i][i]);
    double width = w[i][i];
    for (std::size_t j = 0; j < 3; ++j) {
      if (j == i) continue;
      width *= kept_width(f[j], w[i][j]);
      if (i < j) pairs += (narrowed(f[i], w[i][j]) + narrowed(f[j], w[j][i])) / 2;
    }
    local += narrowed(f[i], width);
  }
  EXPECT_NEAR(field_of(WeightedBlend{SeparateWidths{}, w}, f), separate, 1e-14);
  EXPECT_NEAR(field_of(WeightedBlend{PairWidths{}, w}, f), pairs, 1e-14);
  EXPECT_NEAR(field_of(WeightedBlend{LocalWidths{}, w}, f), local, 1e-14);
}

// Far from all others, a child has its own surface, whatever the weights.
TEST(WeightedBlend, AloneKeepsItsSurface) {
  for (const WidthSolution& how : {WidthSolution(LocalWidths{}), WidthSolution(SeparateWidths{})}) {
    const WeightedBlend blend{how, {{0.2, 0.1}, {0.3, 0.7}}};
    EXPECT_EQ(field_of(blend, {1, 0}), 1);
    EXPECT_EQ(field_of(blend, {0, 1}), 1);
    EXPECT_LT(field_of(blend, {0.999, 0}), 1);
  }
}

TEST(WeightedBlend, Laws) {
  const std::vector<std::vector<double>> w{{0.9, 0.3, 0.6}, {0.5, 1, 0.2}, {0.8, 0.7, 0.4}};
  for (const WidthSolution& how :
       {WidthSolution(LocalWidths{}), WidthSolution(SeparateWidths{}), WidthSolution(PairWidths{})}) {
    test::expect_lawful_operator(WeightedBlend{how, w}, 3, 1);
    test::expect_child_level(WeightedBlend{how, w}, 3, 2);
  }
  const std::vector<double> many(300, 0.5);
  std::vector<std::vector<double>> small(300, std::vector<double>(300, WeightedBlend::least_weight));
  EXPECT_EQ(field_of(WeightedBlend{LocalWidths{}, small}, many), 0);  // widths that vanish divide by nothing
}

TEST(WeightedBlend, RefusesMatricesOfAnotherSize) {
  EXPECT_EQ(WeightedBlend{}.problem(3), "");
  EXPECT_NE((WeightedBlend{LocalWidths{}, {{1, 1}, {1, 1}}}.problem(3)), "");
  EXPECT_NE((WeightedBlend{LocalWidths{}, {{1, 1}, {1}}}.problem(2)), "");
}

}  // namespace
}  // namespace marrow
