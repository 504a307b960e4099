// Where the rays of film points go.
#include "renderer/transport/camera/camera.h"

#include <numbers>

#include <gtest/gtest.h>

#include "field/math/elementary.h"

namespace marrow {
namespace {

TEST(Camera, MiddleOfTheFilmLooksAtTheTarget) {
  for (const auto type : {CameraDescription::Type::Perspective, CameraDescription::Type::Orthographic}) {
    const Camera camera({.type = type, .from = {1, 2, 3}, .to = {-1, 0, 0.5}}, 40, 30);
    const Ray ray = camera.ray(20, 15);
    EXPECT_LT(length(cross(ray.direction.vec(), Vec3d{-1, 0, 0.5} - ray.origin)), 1e-12);
    EXPECT_NEAR(camera.depth({-1, 0, 0.5}), camera.focus_distance(), 1e-12);
  }
}

TEST(Camera, FieldOfViewIsVertical) {
  const Camera camera({.from = {0, 0, 5}, .to = {0, 0, 0}, .fov_deg = 40}, 200, 100);
  const Ray top = camera.ray(100, 0), bottom = camera.ray(100, 100), right = camera.ray(200, 50);
  EXPECT_NEAR(acos(dot(top.direction, bottom.direction)) * 180 / std::numbers::pi, 40, 1e-9);
  EXPECT_GT(top.direction.y(), 0);
  EXPECT_GT(right.direction.x(), 0);
  EXPECT_NEAR(right.direction.x() / -right.direction.z(), 2 * tan(20 * std::numbers::pi / 180), 1e-12);
}

TEST(Camera, OrthographicRaysAreParallelAndSpanTheHeight) {
  const Camera camera({.type = CameraDescription::Type::Orthographic, .height = 3}, 20, 10);
  const Ray top = camera.ray(10, 0), bottom = camera.ray(10, 10), left = camera.ray(0, 5);
  EXPECT_EQ(top.direction, bottom.direction);
  EXPECT_NEAR(length(top.origin - bottom.origin), 3, 1e-12);
  EXPECT_NEAR(left.origin.x, -3, 1e-12);
}

}  // namespace
}  // namespace marrow
