// Names of outputs follow from what was asked.
#include "renderer/app/picture/picture_outputs.h"

#include <gtest/gtest.h>

namespace marrow {
namespace {

RenderCommand command(std::optional<std::filesystem::path> output, std::optional<std::filesystem::path> png) {
  RenderCommand c;
  c.scene.path = "some/folder/neuron.v2.yaml";
  c.output = std::move(output);
  c.png = std::move(png);
  return c;
}

TEST(PictureOutputs, DefaultToTheStemInTheCurrentFolder) {
  const auto outputs = choose_outputs(command({}, {}));
  ASSERT_TRUE(outputs);
  EXPECT_EQ(outputs->exr, "neuron.v2.exr");
  EXPECT_EQ(outputs->png, "neuron.v2.png");
}

TEST(PictureOutputs, AreOnlyWhatIsNamed) {
  EXPECT_FALSE(choose_outputs(command("a.exr", {}))->png);
  EXPECT_FALSE(choose_outputs(command("a.png", {}))->exr);
  EXPECT_FALSE(choose_outputs(command({}, "a.png"))->exr);
  const auto both = choose_outputs(command("a.exr", "b.png"));
  EXPECT_EQ(both->exr, "a.exr");
  EXPECT_EQ(both->png, "b.png");
  EXPECT_EQ(choose_outputs(command("/dev/null", {}))->exr, "/dev/null");
}

TEST(PictureOutputs, RefuseWhatCannotBeMeant) {
  EXPECT_FALSE(choose_outputs(command("a.jpg", {})));
  EXPECT_FALSE(choose_outputs(command("a", {})));
  EXPECT_FALSE(choose_outputs(command({}, "a.exr")));
  EXPECT_FALSE(choose_outputs(command("a.png", "b.png")));
}

}  // namespace
}  // namespace marrow
