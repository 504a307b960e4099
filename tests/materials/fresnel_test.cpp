// Reflectances against closed forms: of dielectrics, their means over the hemisphere [Walsh 1926], of conductors.
#include "materials/fresnel.h"

#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

#include "field/math/elementary.h"

namespace marrow {
namespace {

double cos_deg(double degrees) { return cos(degrees * std::numbers::pi / 180); }

TEST(Fresnel, DielectricHasTheClosedFormValues) {
  for (const auto& [degrees, expected] : {std::pair{0.0, .04},
                                          {30.0, .041522626},
                                          {45.0, .050239911},
                                          {60.0, .089186713},
                                          {75.0, .253060563},
                                          {85.0, .612799645},
                                          {56.309932, .073964497},
                                          {90.0, 1.0}})
    EXPECT_NEAR(fresnel_dielectric(cos_deg(degrees), 1.5), expected, 2e-9) << degrees;
}

TEST(Fresnel, NothingPassesBeyondTheCriticalAngle) {
  EXPECT_LT(fresnel_dielectric(cos_deg(41.8), 1 / 1.5), 1);
  EXPECT_EQ(fresnel_dielectric(cos_deg(41.82), 1 / 1.5), 1);
}

TEST(Fresnel, DiffuseReflectanceEqualsWalsh) {
  for (const auto& [eta, outside, inside] :
       {std::tuple{1.33, .065930849, .471949149}, {1.5, .091777959, .596345760}, {2.0, .160596637, .790149159}}) {
    EXPECT_NEAR(diffuse_fresnel_outside(eta), outside, 2e-9) << eta;
    EXPECT_NEAR(diffuse_fresnel_inside(eta), inside, 2e-9) << eta;
  }
}

TEST(Fresnel, ConductorHasTheClosedFormValues) {
  const ComplexIndex two{{0.2, 1.5, 0.2}, {3.0, 7.6, 3.0}};
  for (const auto& [degrees, first, second] :
       {std::tuple{0.0, .923371648, .906264646}, {45.0, .921319621, .901781924}, {82.0, .947022099, .829242520}}) {
    const Rgb f = fresnel_conductor(cos_deg(degrees), two);
    EXPECT_NEAR(f.r, first, 2e-9) << degrees;
    EXPECT_NEAR(f.g, second, 2e-9) << degrees;
    EXPECT_EQ(f.r, f.b);
  }
}

TEST(Fresnel, ConductorWithoutAbsorptionIsADielectric) {
  const ComplexIndex glass{Rgb(1.5), Rgb(0)};
  for (double mu = 0.05; mu <= 1; mu += 0.05)
    EXPECT_NEAR(fresnel_conductor(mu, glass).r, fresnel_dielectric(mu, 1.5), 1e-14) << mu;
}

TEST(Metals, ReflectBetweenHalfAndAllAndHaveTheirColour) {
  for (const std::string_view name : metal_names()) {
    const Rgb f = fresnel_conductor(1, *metal(name));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(f[i] > 0.35 && f[i] < 1) << name;
  }
  const Rgb gold = fresnel_conductor(1, *metal("gold")), silver = fresnel_conductor(1, *metal("silver"));
  EXPECT_GT(gold.r, gold.g);
  EXPECT_GT(gold.g, gold.b);
  EXPECT_GT(silver.b, 0.9);
  EXPECT_FALSE(metal("unobtainium"));
}

}  // namespace
}  // namespace marrow
