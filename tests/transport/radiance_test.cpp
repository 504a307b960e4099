// Radiance of scenes with closed forms. Seeds are fixed; bounds are 4 standard errors of the means of
// 64 batches, plus what the interpolated tables of materials may be off.
#include <numbers>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "renderer/transport/integrators/path_tracer.h"
#include "tests/transport/estimate.h"
#include "tests/transport/mock_surfaces.h"

namespace marrow {
namespace {

constexpr double pi = std::numbers::pi;
const MockSurfaces floor_only({}, {{{0, 0, 0}, UnitVec3::unchecked({0, 1, 0}), MaterialId(0)}});
const Ray down_to_origin = ray_to({0.3, 2, 0.1}, {0, 0, 0});

void expect_estimate(const Estimate& estimated, double expected, double slack) {
  EXPECT_NEAR(estimated.mean, expected, 4 * estimated.standard_error + slack) << estimated.standard_error;
}

TEST(Radiance, A1_ClosedSphereWithAPointLightHasAGeometricSeries) {
  const MockSurfaces cave({{{0, 0, 0}, 1, MaterialId(0), true}});
  const RenderScene scene = scene_of(cave, {diffuse(0.5)}, {Light(PointSource{{0, 0, 0}, Rgb(pi)})});
  const Ray ray = ray_to({0.2, 0.1, 0}, {1, 0.5, 0.3});
  for (const int bounces : {1, 2, 3}) {
    const Estimate e = radiance(PathTracer(bounces), scene, ray, 16);
    EXPECT_NEAR(e.mean, 1 - std::ldexp(1, -bounces), 1e-7) << bounces;  // offsets of 1e-9, and no noise at all
  }
  expect_estimate(radiance(PathTracer(60), scene, ray, 256), 1, 1e-7);
}

TEST(Radiance, A2_ClosedEmissiveBodyIsAFurnace) {
  const MockSurfaces furnace({{{0, 0, 0}, 1, MaterialId(0), true}});
  for (const auto& [albedo, expected] : {std::pair{0.5, 2.0}, {0.8, 5.0}}) {
    const RenderScene scene = scene_of(furnace, {Material(Bsdf(Diffuse(Rgb(albedo))), Rgb(1))}, {});
    const Ray ray = ray_to({0.2, 0.1, 0}, {1, 0.5, 0.3});
    for (const int bounces : {0, 1, 3})  // L_e (1 - rho^(n+1)) / (1 - rho), without noise while no roulette is played
      EXPECT_NEAR(radiance(PathTracer(bounces), scene, ray, 4).mean, expected * (1 - std::pow(albedo, bounces + 1)),
                  1e-7);
    expect_estimate(radiance(PathTracer(400), scene, ray, 4096), expected, 1e-7);
  }
}

TEST(Radiance, A3_WhiteBodiesInAUniformSkyCannotBeSeen) {
  const MockSurfaces pair({{{-0.7, 0, 0}, 1, MaterialId(0), false}, {{0.8, 0, 0.2}, 0.9, MaterialId(1), false}});
  const ComplexIndex all_reflecting{Rgb(0), Rgb(1)};
  const std::vector<Material> whites{diffuse(1), Material(Bsdf(Conductor(all_reflecting, 0.4))),
                                     Material(Bsdf(Coated(Rgb(1), 0.3, 1.5)))};
  for (const Material& first : whites)
    for (const Material& second : whites) {
      const RenderScene scene = scene_of(pair, {first, second}, {Light(ConstantSky{Rgb(1)})});
      expect_estimate(radiance(PathTracer(1000), scene, ray_to({0.1, 0.1, 4}, {0.05, 0.1, 0.5}), 64), 1, 3e-3);
    }
}

TEST(Radiance, A4_ConvexBodyInAUniformSkyHasItsAlbedo) {
  const MockSurfaces ball({{{0, 0, 0}, 1, MaterialId(0), false}});
  const RenderScene scene = scene_of(ball, {diffuse(0.3)}, {Light(ConstantSky{Rgb(2)})});
  for (const double offset : {0.0, 0.5, 0.99})
    expect_estimate(radiance(PathTracer(16), scene, ray_to({offset, 0, 3}, {offset, 0, 0}), 16), 0.6, 1e-9);
}

TEST(Radiance, A6_PointLightOverAPlane) {
  const RenderScene scene = scene_of(floor_only, {diffuse(0.6)}, {Light(PointSource{{1, 2, 0.5}, Rgb(5)})});
  const double d2 = 1 + 4 + 0.25, cosine = 2 / std::sqrt(d2);
  expect_estimate(radiance(PathTracer(8), scene, down_to_origin, 1), 0.6 * 5 * cosine / (pi * d2), 1e-8);
}

TEST(Radiance, A19_RectangleSeenFromBelowItsCorner) {
  const auto lit_by = [](const RectangleLight& light) {
    const RenderScene scene = scene_of(floor_only, {diffuse(0.5)}, {Light(Rectangle(light, false))});
    return radiance(PathTracer(1), scene, ray_to({-1, 1, -1}, {0, 0, 0}), 1024);
  };
  // Radiance = albedo * form factor * light's radiance
  expect_estimate(lit_by({.center = {0.5, 1, 0.5}, .normal = {0, -1, 0}, .width = 1, .height = 1, .radiance = Rgb(3)}),
                  1.5 * .138531605995, 1e-7);
  expect_estimate(lit_by({.center = {0, 1, 0}, .normal = {0, -1, 0}, .width = 2, .height = 2, .radiance = Rgb(3)}),
                  1.5 * .554126423980, 1e-7);
  EXPECT_EQ(lit_by({.center = {0, 1, 0}, .normal = {0, 1, 0}, .width = 2, .height = 2, .radiance = Rgb(3)}).mean, 0);
}

// A sphere of radius 1 at distance 2 is a disc of 60 degrees in the sky: E = pi L (R/d)^2 cos(theta) above the horizon.
TEST(Radiance, A16_SphereOfLightAboveTheHorizon) {
  const double luminous = 3, facing = pi * luminous * 0.25;
  for (const auto& [tilt, form_factor] : {std::pair{0.0, 0.25}, {60.0, 0.125}}) {
    const SinCos t = sincos(tilt * pi / 180);
    const SunLight disc{.direction = {t.sin, t.cos, 0}, .irradiance = Rgb(facing), .angle_deg = 60};
    const RenderScene scene = scene_of(floor_only, {diffuse(0.5)}, {Light(Sun(disc))});
    expect_estimate(radiance(PathTracer(1), scene, down_to_origin, 1024), 0.5 * luminous * form_factor, 1e-7);
  }
}

TEST(Radiance, SunGivesItsIrradianceWhateverItsSize) {
  for (const double angle : {0.0, 0.53, 40.0}) {
    const SunLight overhead{.direction = {0, 3, 0}, .irradiance = Rgb(3), .angle_deg = angle};
    const SunLight slanted{.direction = {0, 1, 1}, .irradiance = Rgb(3), .angle_deg = angle};
    const double facing = 0.5 * 3 / pi;
    const RenderScene above = scene_of(floor_only, {diffuse(0.5)}, {Light(Sun(overhead))});
    expect_estimate(radiance(PathTracer(1), above, down_to_origin, 256), facing, 1e-7);
    const RenderScene aside = scene_of(floor_only, {diffuse(0.5)}, {Light(Sun(slanted))});
    expect_estimate(radiance(PathTracer(1), aside, down_to_origin, 256), facing * std::sqrt(0.5), 1e-7);
  }
}

TEST(Radiance, A22_SkyThatBrightensUpward) {
  EnvironmentImage image{.width = 64, .height = 256, .rgb = {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width * 3; ++x)
      image.rgb.push_back(static_cast<float>(1 + cos(pi * (y + 0.5) / image.height)));
  const RenderScene scene =
      scene_of(floor_only, {diffuse(0.5)}, {Light(Environment(std::move(image), Rgb(1), 30, false))});
  // The image is linear between rows: off by at most (pi/256)^2 / 8 = 2e-5
  expect_estimate(radiance(PathTracer(1), scene, down_to_origin, 1024), 0.5 * 5.235987756 / pi, 3e-5);
}

TEST(Radiance, A30_ShadowOfASphereOnTheSkyLight) {
  const MockSurfaces ball_on_floor({{{0, 1, 0}, 1, MaterialId(1), false}},
                                   {{{0, 0, 0}, UnitVec3::unchecked({0, 1, 0}), MaterialId(0)}});
  const RenderScene scene = scene_of(ball_on_floor, {diffuse(1), diffuse(0)}, {Light(ConstantSky{Rgb(1)})});
  for (const auto& [x, visible] : {std::pair{0.5, .284458}, {1.0, .646447}, {2.0, .910557}})
    expect_estimate(radiance(PathTracer(8), scene, ray_to({x + 3, 0.5, 0}, {x, 0, 0}), 512), visible, 1e-6);
}

TEST(Radiance, LightsAreAddedTogether) {
  const std::vector<Light> lights{Light(ConstantSky{Rgb(0.2)}), Light(Sun({.direction = {1, 2, 0}})),
                                  Light(PointSource{{1, 2, 0.5}, Rgb(5)}),
                                  Light(Rectangle({.center = {0, 1, 0}, .normal = {0, -1, 0}}, false))};
  const Ray ray = ray_to({-2, 0.4, 0.1}, {0, 0, 0});
  double sum = 0, errors = 0;
  for (const Light& light : lights) {
    const Estimate one = radiance(PathTracer(2), scene_of(floor_only, {diffuse(0.5)}, {light}), ray, 256);
    sum += one.mean;
    errors += one.standard_error;
  }
  expect_estimate(radiance(PathTracer(2), scene_of(floor_only, {diffuse(0.5)}, lights), ray, 1024), sum, 4 * errors);
}

}  // namespace
}  // namespace marrow
