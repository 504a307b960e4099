// Pictures have the same bits however they are made, and stop when told.
#include "renderer/transport/render.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cfenv>
#include <numbers>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "renderer/transport/pixel_block.h"
#include "tests/transport/mock_surfaces.h"

namespace marrow {
namespace {

const MockSurfaces ball_on_floor({{{0, 1, 0}, 1, MaterialId(0), false}},
                                 {{{0, 0, 0}, UnitVec3::unchecked({0, 1, 0}), MaterialId(1)}});

RenderScene studio(int width, int height, const Surfaces& surfaces = ball_on_floor) {
  SceneDescription d;
  d.camera = {.from = {2, 2, 5}, .to = {0, 1, 0}};
  d.film = {width, height};
  d.materials = {{"gold", ConductorDescription{}, {}}, {"white", DiffuseDescription{}, {}}};
  d.lights = {{ConstantLight{Rgb(0.3)}, {}},
              {SunLight{}, {}},
              {RectangleLight{.center = {2, 3, 1}, .normal = {-1, -1, 0}, .radiance = Rgb(5)}, {}}};
  return *compile_transport(d, surfaces, nullptr);
}

void expect_same_bits(const Picture& a, const Picture& b) {
  ASSERT_EQ(a.data, b.data);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t i = 0; i < a.channels.size(); ++i)
    EXPECT_EQ(a.channels[i].samples, b.channels[i].samples) << a.channels[i].name;
}

TEST(Render, BitsDoNotDependOnThreads) {
  const RenderScene scene = studio(70, 50);
  const RenderSettings settings{.samples_per_pixel = 5};
  const Picture one = picture_of(to_rows(render(scene, settings, {.threads = 1})));
  for (const int threads : {0, 2, 7})
    expect_same_bits(one, picture_of(to_rows(render(scene, settings, {.threads = threads}))));
}

// Blocks of pixels whose rays go together are cut by tiles.
TEST(Render, BitsDoNotDependOnTiles) {
  const RenderScene scene = studio(37, 21);
  for (const int samples : {1, 5, 16}) {
    const RenderSettings settings{.samples_per_pixel = samples};
    const Picture usual = picture_of(to_rows(render(scene, settings, {.tile_size = 16})));
    for (const int side : {1, 3, 7})
      expect_same_bits(usual, picture_of(to_rows(render(scene, settings, {.tile_size = side}))));
  }
}

// Counts how many rays come together.
class CountingSurfaces final : public Surfaces {
 public:
  explicit CountingSurfaces(const Surfaces& surfaces) : surfaces_(surfaces) {}
  std::optional<SurfaceHit> first_hit(const Ray& ray, RayRecord& record) const override {
    return surfaces_.first_hit(ray, record);
  }
  bool occluded(const Ray& ray) const override { return surfaces_.occluded(ray); }
  void first_hits(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const override {
    together.push_back(rays.size());
    surfaces_.first_hits(rays, hits);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const override {
    shadow_rays.push_back(rays.size());
    surfaces_.occluded(rays, hidden);
  }
  bool traces_packets() const override { return true; }
  Box3 bounds() const override { return surfaces_.bounds(); }

  mutable std::vector<std::size_t> together, shadow_rays;

 private:
  const Surfaces& surfaces_;
};

TEST(Render, RaysOfABlockOfPixelsGoTogether) {
  const CountingSurfaces counting(ball_on_floor);
  const RenderScene scene = studio(40, 10, counting);
  render(scene, {.integrator = RenderSettings::Integrator::Direct, .samples_per_pixel = 4},
         {.threads = 1, .tile_size = 32});
  // The first sample: a block of 32 columns and one of 8
  EXPECT_EQ(std::ranges::count(counting.together, 320u), 1);
  EXPECT_EQ(std::ranges::count(counting.together, 80u), 1);
  // Three more samples of each pixel: two blocks of 16 columns and one of 8
  EXPECT_EQ(std::ranges::count(counting.together, 480u), 2);
  EXPECT_EQ(std::ranges::count(counting.together, 240u), 1);
  EXPECT_GT(std::ranges::max(counting.shadow_rays), 100u);
}

TEST(Render, BlocksOfMoreSamplesHaveFewerPixels) {
  for (const int side : {block_side, side_of_block_of_lone_rays})
    for (int samples = 1; samples <= 16; ++samples) {
      const auto [width, height] = block_size(samples, side);
      EXPECT_GE(width * height * samples, side * side) << samples;
      EXPECT_LT(width * height * samples, 2 * side * side) << samples;
    }
}

// Blocks are smaller where rays gain nothing by company.
TEST(Render, BitsDoNotDependOnWhatGoesTogether) {
  const CountingSurfaces in_packets(ball_on_floor);
  const RenderSettings settings{.samples_per_pixel = 5};
  expect_same_bits(picture_of(to_rows(render(studio(70, 50), settings))),
                   picture_of(to_rows(render(studio(70, 50, in_packets), settings, {.threads = 1}))));
}

// A program that embeds the renderer may have set another rounding, on which every sum depends.
TEST(Render, BitsDoNotDependOnTheHostsFloatingPointSettings) {
  const RenderScene scene = studio(40, 30);
  const RenderSettings settings{.samples_per_pixel = 3};
  const Picture usual = picture_of(to_rows(render(scene, settings, {.threads = 2})));
  std::fesetround(FE_UPWARD);
  const Film film = render(scene, settings, {.threads = 2});
  EXPECT_EQ(std::fegetround(), FE_UPWARD);  // the host keeps its own
  std::fesetround(FE_TONEAREST);
  expect_same_bits(usual, picture_of(to_rows(film)));
}

TEST(Render, CropEqualsTheWholeBitByBit) {
  const RenderScene scene = studio(70, 50);
  const RenderSettings settings{.samples_per_pixel = 3};
  const PixelWindow crop{13, 7, 42, 61};
  const Film whole = render(scene, settings), part = render(scene, settings, {.crop = crop});
  ASSERT_EQ(part.data(), (PixelWindow{13, 7, 42, 50}));
  for (int y = 7; y < 50; ++y)
    for (int x = 13; x < 42; ++x) {
      ASSERT_EQ(part.at(x, y).mean(), whole.at(x, y).mean());
      ASSERT_EQ(part.at(x, y).variance_of_mean(), whole.at(x, y).variance_of_mean());
      ASSERT_EQ(part.at(x, y).centre.depth, whole.at(x, y).centre.depth);
    }
}

TEST(Render, CropOutsideTheFilmIsEmpty) {
  const Film film = render(studio(8, 8), {.samples_per_pixel = 1}, {.crop = PixelWindow{20, 20, 30, 30}});
  EXPECT_TRUE(film.pixels().empty());
}

TEST(Render, SeedChangesTheNoise) {
  const RenderScene scene = studio(16, 16);
  const Film a = render(scene, {.samples_per_pixel = 2, .seed = 1}),
             b = render(scene, {.samples_per_pixel = 2, .seed = 2});
  EXPECT_NE(a.at(8, 8).mean(), b.at(8, 8).mean());
  EXPECT_EQ(a.at(8, 8).centre.depth, b.at(8, 8).centre.depth);
}

TEST(Render, NormalsAndDepthTakeOneSampleThroughThePixelsMiddle) {
  const RenderScene scene = studio(32, 32);
  const Film normals = render(scene, {.integrator = RenderSettings::Integrator::Normals});
  const Film depth = render(scene, {.integrator = RenderSettings::Integrator::Depth});
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const CentreHit& centre = normals.at(x, y).centre;
      EXPECT_EQ(normals.at(x, y).samples(), 1u);
      EXPECT_EQ(depth.at(x, y).centre.depth, centre.depth);
      if (centre.object == 0) {
        EXPECT_EQ(centre.depth, std::numeric_limits<float>::infinity());
        EXPECT_TRUE(is_black(normals.at(x, y).mean()));
        EXPECT_TRUE(is_black(depth.at(x, y).mean()));
      } else {
        EXPECT_NEAR(normals.at(x, y).mean().g, (centre.normal[1] + 1) / 2, 1e-6);
        const double focus = scene.camera.focus_distance();
        EXPECT_NEAR(depth.at(x, y).mean().r, focus / (focus + centre.depth), 1e-6);
      }
    }
}

TEST(Render, ProgressCountsEverySample) {
  Progress last;
  const Film film =
      render(studio(20, 10), {.samples_per_pixel = 6}, {.progress = [&](const Progress& p) { last = p; }});
  EXPECT_EQ(last.done, 1200u);
  EXPECT_EQ(last.total, 1200u);
  EXPECT_EQ(last.samples_per_pixel, 6);
  EXPECT_EQ(film.stopped_by, StopReason::Samples);
}

TEST(Render, TimeLimitStopsWithAnEvenPicture) {
  Progress last;
  const Film film = render(studio(20, 10), {.samples_per_pixel = 1 << 30},
                           {.time_limit_s = 0.05, .progress = [&](const Progress& p) { last = p; }});
  EXPECT_LE(last.left_s, 0.05);
  EXPECT_EQ(film.stopped_by, StopReason::Time);
  const std::uint32_t samples = film.pixels()[0].samples();
  EXPECT_GE(samples, 1u);
  for (const PixelSums& p : film.pixels()) EXPECT_EQ(p.samples(), samples);
  EXPECT_LT(film.elapsed_s, 5);
}

TEST(Render, InterruptedRenderKeepsWhatItHas) {
  const std::atomic<bool> at_once = true;
  const Film none = render(studio(20, 10), {.samples_per_pixel = 4}, {.interrupted = &at_once});
  EXPECT_EQ(none.stopped_by, StopReason::Interrupted);
  EXPECT_EQ(none.pixels()[0].samples(), 0u);
  EXPECT_EQ(none.pixels()[0].mean(), Rgb());
}

// Rays may take long one by one. Those of one block are all that may still be traced: 4 x 4 rays of the camera.
TEST(Render, InterruptedRenderEndsBeforeItsTile) {
  class Interrupting final : public Surfaces {
   public:
    explicit Interrupting(std::size_t after) : after_(after) {}
    using Surfaces::first_hit;
    std::optional<SurfaceHit> first_hit(const Ray& ray, RayRecord& record) const override {
      if (++rays > after_) interrupted = true;
      return ball_on_floor.first_hit(ray, record);
    }
    bool occluded(const Ray& ray) const override { return ball_on_floor.occluded(ray); }
    Box3 bounds() const override { return ball_on_floor.bounds(); }
    mutable std::size_t rays = 0;
    mutable std::atomic<bool> interrupted = false;

   private:
    std::size_t after_;
  };
  constexpr std::size_t scouts = 32 * 32 / (32 * 32) + 32 * 32 / (8 * 8), after = scouts + 100;
  const Interrupting surfaces(after);
  Progress last;
  const Film film =
      render(studio(32, 32, surfaces), {.integrator = RenderSettings::Integrator::Normals},
             {.threads = 1, .progress = [&](const Progress& p) { last = p; }, .interrupted = &surfaces.interrupted});
  EXPECT_EQ(film.stopped_by, StopReason::Interrupted);
  EXPECT_GT(surfaces.rays, after);
  EXPECT_LE(surfaces.rays, after + 16);
  EXPECT_EQ(last.done, surfaces.rays - scouts);
}

// A35: a Lambert sphere under a distant light, mean over its disc. N = 64 x 64 pixels of 16 samples; the edge of the
// disc makes the error: bound 2e-3 of the value, about 4 standard errors of the mean over seeds.
TEST(Render, A35_PhasesOfASphere) {
  const MockSurfaces ball({{{0, 0, 0}, 1, MaterialId(0), false}});
  for (const double phase : {0.0, 1.0, 2.0}) {
    SceneDescription d;
    d.camera = {.type = CameraDescription::Type::Orthographic, .from = {0, 0, 5}, .height = 2.5};
    d.film = {64, 64};
    d.materials = {{"white", DiffuseDescription{Rgb(0.7)}, {}}};
    d.lights = {{SunLight{.direction = {sin(phase), 0, cos(phase)}, .irradiance = Rgb(4), .angle_deg = 0}, {}}};
    const Film film = render(*compile_transport(d, ball, nullptr), {.samples_per_pixel = 16});
    double sum = 0;
    for (const PixelSums& p : film.pixels()) sum += p.mean().g;
    constexpr double pi = std::numbers::pi;
    const double over_disc = sum / (64 * 64) * 2.5 * 2.5 / pi;
    const double expected = 0.7 * 4 / pi * 2 / (3 * pi) * (sin(phase) + (pi - phase) * cos(phase));
    EXPECT_NEAR(over_disc, expected, 2e-3 * expected) << phase;
  }
}

}  // namespace
}  // namespace marrow
