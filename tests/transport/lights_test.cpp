// Laws of every light: samples, densities and what rays see agree.
#include <numbers>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "renderer/transport/lights/light_set.h"
#include "tests/transport/estimate.h"

namespace marrow {
namespace {

constexpr double pi = std::numbers::pi;

EnvironmentImage spotted(int width, int height) {
  EnvironmentImage image{.width = width, .height = height, .rgb = {}};
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < 3; ++c) image.rgb.push_back(i % 7 == 0 ? 0.0f : static_cast<float>(1 + i % 5 + c));
  return image;
}

const Receiver receiver{{0.1, 0.2, 0.3}, normalize({0.2, 1, 0.1})};

std::vector<Light> lights_with_extent() {
  return {Light(ConstantSky{Rgb(2)}),
          Light(Environment(spotted(16, 8), Rgb(1, 2, 3), 77, false)),
          Light(Environment(spotted(16, 8), Rgb(1), 0, true)),
          Light(Sun({.direction = {0.3, 1, 0}, .irradiance = Rgb(2), .angle_deg = 30})),
          Light(Rectangle({.center = {1, 2, 0}, .normal = {-0.3, -1, 0}, .width = 2, .height = 3}, false)),
          Light(Rectangle({.center = {1, 9, 0}, .normal = {-0.3, -1, 0}, .width = 0.1, .height = 0.2}, false))};
}

Rgb seen(const Light& light, const UnitVec3& wi) {
  if (const auto hit = light.hit({.origin = receiver.position, .direction = wi})) return hit->radiance;
  return light.escaped(wi);
}

TEST(Lights, SamplesHaveTheDensityAndRadianceThatRaysSee) {
  for (const Light& light : lights_with_extent()) {
    Sampler sampler(1, 2, 3);
    int agree = 0, n = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
      sampler.start(i);
      const auto s = light.sample(receiver, sampler.next_2d());
      if (!s) continue;
      ++n;
      EXPECT_NEAR(length(s->wi), 1, 1e-12);
      // Rounding may put a direction on the other side of an edge of a pixel or of the light
      agree += std::fabs(light.pdf(receiver, s->wi) / s->pdf - 1) < 1e-9 &&
               std::fabs(seen(light, s->wi).g - s->radiance.g) <= 1e-9 * s->radiance.g;
    }
    EXPECT_GT(n, 1000);
    EXPECT_GE(agree, n - 3) << light.source().index();
  }
}

// Irradiance from light samples = from directions drawn by the cosine. N = 64 x 4096, 4 standard errors.
TEST(Lights, SamplesAndDirectionsGiveTheSameIrradiance) {
  const Frame frame = Frame::around(receiver.normal);
  for (const Light& light : lights_with_extent()) {
    const Estimate asked = estimate(4096, [&](Sampler& sampler) {
      const auto s = light.sample(receiver, sampler.next_2d());
      return s ? s->radiance.g * std::max(dot(s->wi, receiver.normal), 0.0) / s->pdf : 0.0;
    });
    const Estimate met = estimate(4096, [&](Sampler& sampler) {
      const UnitVec3 local = sample_cosine(sampler.next_2d());
      return seen(light, UnitVec3::unchecked(frame.to_world(local))).g * pi;
    });
    EXPECT_NEAR(asked.mean, met.mean, 4 * std::hypot(asked.standard_error, met.standard_error) + 1e-9)
        << light.source().index();
    EXPECT_GT(asked.mean, 0);
  }
}

TEST(Environment, DensityIntegratesToOne) {
  const Environment sky(spotted(16, 8), Rgb(1), 0, false);
  double sum = 0;
  constexpr int rows = 160, columns = 320;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double theta = pi * (y + 0.5) / rows, phi = 2 * pi * (x + 0.5) / columns;
      const double solid_angle = 2 * pi / columns * (cos(pi * y / rows) - cos(pi * (y + 1) / rows));
      sum += solid_angle * sky.pdf(UnitVec3::unchecked({sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi)}));
    }
  EXPECT_NEAR(sum, 1, 1e-5);
}

// One bright pixel beside the middle column: where is it?
TEST(Environment, PointsWhereItsHeaderSays) {
  EnvironmentImage image{.width = 64, .height = 32, .rgb = std::vector<float>(64 * 32 * 3, 0)};
  for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * (16 * 64 + 32) + c] = 1;
  const auto brightest = [&](double rotate, bool z_up) {
    return Environment(image, Rgb(1), rotate, z_up).sample({0.5, 0.5})->wi.vec();
  };
  const auto expect_near = [](const Vec3d& a, const Vec3d& b) { EXPECT_LT(length(a - b), 0.1); };
  expect_near(brightest(0, false), {0, 0, -1});
  expect_near(brightest(90, false), {-1, 0, 0});
  expect_near(brightest(0, true), {0, 1, 0});
  expect_near(brightest(90, true), {-1, 0, 0});
}

TEST(Environment, BlackImageGivesNothing) {
  const Light black(Environment({.width = 4, .height = 2, .rgb = std::vector<float>(24, 0)}, Rgb(1), 0, false));
  EXPECT_FALSE(black.sample(receiver, {0.3, 0.4}));
  EXPECT_EQ(black.pdf(receiver, receiver.normal), 0);
}

// The solid angle of a square of side 2 seen from distance 1 above its middle is 4 asin(1/2) = 2 pi / 3: one face of a
// cube. Shares of samples in quarters of a face seen aslant are shares of solid angle.
TEST(SphericalRectangle, SamplesAreUniformInSolidAngle) {
  EXPECT_NEAR(SphericalRectangle(-1, 1, -1, 1, -1).solid_angle(), 2 * pi / 3, 1e-14);
  const SphericalRectangle whole(-0.2, 3, 0.1, 2, -0.5);
  for (const double x : {0.0, 0.5, 1.5})
    for (const double y : {0.3, 1.0}) {
      const double share = SphericalRectangle(-0.2, x, 0.1, y, -0.5).solid_angle() / whole.solid_angle();
      const Estimate inside = estimate(1024, [&](Sampler& sampler) {
        const Sample2 p = whole.sample(sampler.next_2d());
        return p.x < x && p.y < y ? 1.0 : 0.0;
      });
      EXPECT_NEAR(inside.mean, share, 4 * inside.standard_error) << x << ' ' << y;
    }
}

TEST(Rectangle, HeightRunsUpAndWidthAcross) {
  const Rectangle wide({.center = {0, 0, 0}, .normal = {0, 0, 1}, .width = 4, .height = 1}, false);
  EXPECT_TRUE(wide.hit(ray_to({1.9, 0.4, 1}, {1.9, 0.4, 0})));
  EXPECT_FALSE(wide.hit(ray_to({0.4, 1.9, 1}, {0.4, 1.9, 0})));
  const Rectangle ceiling({.center = {0, 0, 0}, .normal = {0, -1, 0}, .width = 4, .height = 1}, false);
  EXPECT_TRUE(ceiling.hit(ray_to({1.9, -1, 0.4}, {1.9, 0, 0.4})));
  EXPECT_FALSE(ceiling.hit(ray_to({0.4, -1, 1.9}, {0.4, 0, 1.9})));
}

TEST(LightSet, PicksWithItsProbabilities) {
  const LightSet set(lights_with_extent(), {});
  double total = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    total += set.probability(i);
    EXPECT_GE(set.probability(i), 0.5 / double(set.size()) - 1e-12);
  }
  EXPECT_NEAR(total, 1, 1e-12);
  std::vector<int> counts(set.size());
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const LightSet::Pick pick = set.pick((i + 0.5) / n);
    const auto which = static_cast<std::size_t>(pick.light - &set[0]);
    EXPECT_EQ(pick.probability, set.probability(which));
    ++counts[which];
  }
  for (std::size_t i = 0; i < set.size(); ++i) EXPECT_NEAR(counts[i] / double(n), set.probability(i), 2.0 / n);
}

}  // namespace
}  // namespace marrow
