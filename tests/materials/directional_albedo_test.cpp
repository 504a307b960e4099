// Energy of single bounces against quadrature.
#include "materials/directional_albedo.h"

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "materials/fresnel.h"

namespace marrow {
namespace {

DirectionalAlbedo white(double alpha) {
  return DirectionalAlbedo(Ggx(alpha), [](double) { return 1.0; });
}

struct Row {
  double alpha, at_1, at_half, at_tenth, average;
};
constexpr Row rows[] = {{.0625, .995690, .988324, .896773, .987370}, {.10, .988309, .969205, .883453, .972092},
                        {.25, .915812, .857263, .891622, .882324},   {.50, .687849, .698251, .860105, .700241},
                        {.75, .463917, .564623, .810714, .536303},   {1.0, .306853, .450694, .760210, .409137}};

TEST(DirectionalAlbedo, EqualsQuadrature) {
  for (const Row& row : rows) {
    const DirectionalAlbedo e = white(row.alpha);
    EXPECT_NEAR(e(1), row.at_1, 1e-3) << row.alpha;
    EXPECT_NEAR(e(0.5), row.at_half, 1e-3) << row.alpha;
    EXPECT_NEAR(e(0.1), row.at_tenth, 2e-3) << row.alpha;
    EXPECT_NEAR(e.average(), row.average, 1e-3) << row.alpha;
  }
}

TEST(DirectionalAlbedo, OfTheRoughestSurfaceSeenFromAboveIsOneMinusLogTwo) {
  EXPECT_NEAR(white(1)(1), 1 - log(2.0), 1e-3);
}

TEST(DirectionalAlbedo, AverageIsTheIntegralOfTheTable) {
  const DirectionalAlbedo e = white(0.3);
  constexpr int n = 200000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n;
    sum += 2 * e(mu) * mu / n;
  }
  EXPECT_NEAR(e.average(), sum, 1e-7);
}

TEST(DirectionalAlbedo, OfASmoothDielectricIsItsFresnelReflectance) {
  const DirectionalAlbedo e(Ggx::of_roughness(0), [](double c) { return fresnel_dielectric(c, 1.5); });
  EXPECT_NEAR(e(1), 0.04, 1e-6);
  EXPECT_NEAR(e(0.5), 0.089186713, 1e-3);
  EXPECT_NEAR(e.average(), 0.091777959, 1e-3);
}

}  // namespace
}  // namespace marrow
