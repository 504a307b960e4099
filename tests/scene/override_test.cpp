// Values from the command line.
#include "renderer/scene/override.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace marrow {
namespace {

using testing::HasSubstr;
using Override = SceneText;

const std::string scene_text = R"(marrow: 1
materials: {gold: {conductor: {}}, skin: {diffuse: {}}}
objects:
  - name: creature
    material: skin
    field: {blend: {alpha: contact, of: [{point: {at: [0, 0, 0]}}]}}
)";

TEST_F(Override, ReachesEveryValue) {
  const auto scene = read(scene_text, {.overrides = {"render.spp=4", "camera.fov=20deg", "objects.0.material=gold",
                                                     "objects.creature.field.blend.alpha=0.9",
                                                     "objects.creature.field.blend.of.0.point.at=[1, 2, 3]",
                                                     "film={size: [8, 4]}", "render.spp=5"}});
  ASSERT_TRUE(scene) << render_all(scene.why(), record.sources);
  EXPECT_EQ(scene->render.samples_per_pixel, 5);
  EXPECT_EQ(scene->camera.fov_deg, 20);
  EXPECT_EQ(scene->film.width, 8);
  EXPECT_EQ(scene->objects[0].material, MaterialId{0});
  const auto& field = std::get<FieldDescription>(scene->objects[0].shape);
  EXPECT_EQ(std::get<double>(std::get<Blend>(field[field.root].what).alpha), 0.9);
}

TEST_F(Override, MistakesHavePlaces) {
  const auto says = [&](const std::string& override_text) {
    return error_of(scene_text, {.overrides = {"render.spp=4", override_text}});
  };
  EXPECT_THAT(says("render.spp=many"), HasSubstr("-D:2:12: error: `spp` must be a whole number"));
  EXPECT_THAT(says("render.ssp=4"), HasSubstr("-D:2:8: error: unknown key `ssp`"));
  EXPECT_THAT(says("objects.creatrue.material=gold"), HasSubstr("did you mean `creature`?"));
  EXPECT_THAT(says("objects.1.material=gold"), HasSubstr("-D:2:9: error: there is no item 1"));
  EXPECT_THAT(says("marrow.x=1"), HasSubstr("leads into `1`"));
  EXPECT_THAT(says("render"), HasSubstr("an override is path=value"));
  EXPECT_THAT(says("=4"), HasSubstr("an override is path=value"));
  EXPECT_THAT(says("film.size=[1"), HasSubstr("-D:2:"));
  EXPECT_THAT(says("include=other.yaml"), HasSubstr("-D:2:1: error: `include` cannot be set here"));
}

}  // namespace
}  // namespace marrow
