// The two ways to find light agree, and so does their combination.
#include "renderer/transport/integrators/path_tracer.h"

#include <gtest/gtest.h>

#include "tests/transport/estimate.h"
#include "tests/transport/mock_surfaces.h"

namespace marrow {
namespace {

using Strategy = PathTracer::Strategy;

const MockSurfaces floor_only({}, {{{0, 0, 0}, UnitVec3::unchecked({0, 1, 0}), MaterialId(0)}});

// Bounds: 4 standard errors of the difference of two means of 64 batches; fixed seeds.
void expect_agreement(const RenderScene& scene, const Ray& ray, const std::string& what) {
  const Estimate both = radiance(PathTracer(1), scene, ray, 512);
  for (const Strategy strategy : {Strategy::LightsOnly, Strategy::SurfacesOnly}) {
    const Estimate one = radiance(PathTracer(1, strategy), scene, ray, 2048);
    EXPECT_NEAR(one.mean, both.mean, 4 * std::hypot(one.standard_error, both.standard_error) + 1e-9) << what;
  }
  EXPECT_GT(both.mean, 0) << what;
}

TEST(PathTracer, StrategiesAgreeOnMetalUnderRectangles) {
  for (const double roughness : {0.2, 0.4, 0.7})
    for (const double size : {0.3, 2.0}) {
      const Material gold(Bsdf(Conductor(*metal("gold"), roughness)));
      const Light light(Rectangle({.center = {2, 2, 0}, .normal = {-1, -1, 0}, .width = size, .height = size}, false));
      expect_agreement(scene_of(floor_only, {gold}, {light}), ray_to({-2, 2, 0.1}, {0, 0, 0}),
                       "roughness " + std::to_string(roughness) + ", size " + std::to_string(size));
    }
}

TEST(PathTracer, StrategiesAgreeOnCoatsUnderSkies) {
  EnvironmentImage image{.width = 32, .height = 16, .rgb = std::vector<float>(32 * 16 * 3, 0.5f)};
  for (std::size_t i = 0; i < 30; ++i) image.rgb[3 * (32 * 4 + 5) + i] = 20;
  const std::vector<Light> lights{Light(Environment(image, Rgb(1), 20, false)), Light(ConstantSky{Rgb(0.3)}),
                                  Light(Sun({.direction = {1, 1, 0}, .irradiance = Rgb(2), .angle_deg = 20}))};
  const Material coat(Bsdf(Coated(Rgb(0.5), 0.4, 1.5)));
  expect_agreement(scene_of(floor_only, {coat}, lights), ray_to({-2, 2, 0.1}, {0, 0, 0}), "skies");
}

// Rays that meet the floor, the light or nothing, side by side and one by one.
TEST(PathTracer, SamplesTogetherAreThoseAlone) {
  const std::vector<Light> lights{
      Light(Rectangle({.center = {2, 2, 0}, .normal = {-1, -1, 0}, .width = 2, .height = 2}, false)),
      Light(Sun({.direction = {1, 1, 0}, .irradiance = Rgb(2), .angle_deg = 20}))};
  const RenderScene scene = scene_of(floor_only, {diffuse(0.8)}, lights);
  std::vector<Ray> rays;
  std::vector<std::optional<SurfaceHit>> first;
  for (int i = 0; i < 16; ++i) {
    rays.push_back(ray_to({-2, 2, 0.1}, {0.3 * i, 0.3 * (i % 8), 0}));
    first.push_back(floor_only.first_hit(rays.back()));
  }
  for (const Strategy strategy : {Strategy::Both, Strategy::LightsOnly, Strategy::SurfacesOnly})
    for (const int depth : {1, 5}) {
      const PathTracer tracer(depth, strategy);
      for (const std::size_t count : {16, 5, 0}) {
        std::vector<Sampler> samplers;
        for (std::size_t i = 0; i < count; ++i) samplers.emplace_back(static_cast<int>(i), 3, 1);
        std::vector<Sampler> alone = samplers;
        std::vector<Rgb> together(count);
        tracer.radiances({std::span(rays).first(count), std::span(first).first(count), samplers}, scene, together);
        for (std::size_t i = 0; i < count; ++i)
          EXPECT_EQ(together[i], tracer.radiance(rays[i], first[i], scene, alone[i])) << i;
      }
    }
}

// Weighting keeps the noise near that of the better way, down to a thousandth of the light.
TEST(PathTracer, WeightsTakeTheBetterStrategy) {
  const Light light(Rectangle({.center = {2, 2, 0}, .normal = {-1, -1, 0}, .width = 1, .height = 1}, false));
  for (const double roughness : {0.1, 0.8}) {
    const Material gold(Bsdf(Conductor(*metal("gold"), roughness)));
    const RenderScene scene = scene_of(floor_only, {gold}, {light});
    const Ray ray = ray_to({-2, 2, 0.1}, {0, 0, 0});
    const Estimate both = radiance(PathTracer(1), scene, ray, 256);
    const double lights = radiance(PathTracer(1, Strategy::LightsOnly), scene, ray, 256).standard_error;
    const double surfaces = radiance(PathTracer(1, Strategy::SurfacesOnly), scene, ray, 256).standard_error;
    EXPECT_LT(both.standard_error, 2 * std::min(lights, surfaces) + 1e-3 * both.mean) << roughness;
    EXPECT_LT(both.standard_error, std::max(lights, surfaces)) << roughness;
  }
}

TEST(PathTracer, RouletteKeepsTheMean) {
  const MockSurfaces cave({{{0, 0, 0}, 1, MaterialId(0), true}});
  const RenderScene scene = scene_of(cave, {diffuse(0.8)}, {Light(PointSource{{0, 0, 0}, Rgb(1)})});
  const Ray ray = ray_to({0.2, 0.1, 0}, {1, 0.5, 0.3});
  // A1: rho I / (pi (1 - rho)), of which 40 bounces leave out 0.8^40 = 1.3e-4
  const Estimate e = radiance(PathTracer(40), scene, ray, 512);
  EXPECT_NEAR(e.mean, 0.8 / (3.14159265358979 * 0.2) * (1 - 1.3292e-4), 4 * e.standard_error + 1e-7);
}

TEST(PathTracer, SeesLightsDirectlyAndOnlyFromTheirFront) {
  const MockSurfaces nothing({});
  const RenderScene scene =
      scene_of(nothing, {}, {Light(Rectangle({.center = {0, 0, 0}, .normal = {0, 0, 1}, .radiance = Rgb(7)}, false))});
  EXPECT_EQ(radiance(PathTracer(1), scene, ray_to({0, 0, 3}, {0.1, 0.2, 0}), 1).mean, 7);
  EXPECT_EQ(radiance(PathTracer(1), scene, ray_to({0, 0, -3}, {0.1, 0.2, 0}), 1).mean, 0);
  EXPECT_EQ(radiance(PathTracer(1), scene, ray_to({0, 0, 3}, {0.6, 0, 0}), 1).mean, 0);
}

}  // namespace
}  // namespace marrow
