// From a description to a scene, and what is told about mistakes.
#include <gtest/gtest.h>

#include "renderer/transport/render_scene.h"
#include "tests/transport/mock_surfaces.h"

namespace marrow {
namespace {

const MockSurfaces ball({{{0, 0, 0}, 1, MaterialId(0), false}});
const LoadEnvironment no_files = [](const std::filesystem::path& file) -> Result<EnvironmentImage> {
  return failure("cannot read", file.string());
};

SceneDescription good() {
  SceneDescription scene;
  scene.materials = {{"white", DiffuseDescription{}, {}}};
  scene.lights = {{ConstantLight{}, {}}, {SunLight{}, {}}, {RectangleLight{}, {}}, {PointLight{}, {}}};
  return scene;
}

TEST(CompileTransport, TakesEveryKindOfLight) {
  SceneDescription scene = good();
  scene.lights.push_back({ImageLight{.file = "sky.exr"}, {}});
  const auto load = [](const std::filesystem::path&) -> Result<EnvironmentImage> {
    return EnvironmentImage{.width = 2, .height = 1, .rgb = std::vector<float>(6, 1)};
  };
  const auto compiled = compile_transport(scene, ball, load);
  ASSERT_TRUE(compiled);
  EXPECT_EQ(compiled->lights.size(), 5u);
  EXPECT_EQ(compiled->width, 1280);
}

TEST(CompileTransport, GathersEveryProblemWithItsPlace) {
  SceneDescription scene = good();
  scene.materials.push_back({"odd", ConductorDescription{.metal = "mithril"}, {"scene.yaml", 4, 5}});
  scene.lights.push_back({SunLight{.direction = {0, 0, 0}}, {"scene.yaml", 8, 1}});
  scene.lights.push_back({ImageLight{.file = "missing.exr"}, {"scene.yaml", 9, 1}});
  scene.camera.to = scene.camera.from;
  const auto compiled = compile_transport(scene, ball, no_files);
  ASSERT_FALSE(compiled);
  const Diagnostics& why = compiled.why();
  ASSERT_GE(why.size(), 4u);
  EXPECT_EQ(why[0].where.line, 4);
  EXPECT_EQ(why[1].where.line, 8);
  EXPECT_EQ(why[2].where.file, "missing.exr");
}

}  // namespace
}  // namespace marrow
