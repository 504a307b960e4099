// Laws of the common image files.
#include "renderer/output/image_file.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "renderer/output/exr.h"
#include "tests/output/temporary_folder.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;

RgbImage ramp() {
  RgbImage image(16, 16);
  for (std::size_t i = 0; i < image.samples.size(); ++i) image.samples[i] = static_cast<float>(i % 256) / 255;
  return image;
}

// IEC 61966-2-1
float encoded(float linear) {
  return static_cast<float>(linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f);
}

TEST(ImageFile, PngReadsBackToItsCodes) {
  const TemporaryFolder folder;
  for (const PngDepth depth : {PngDepth::Bits8, PngDepth::Bits16}) {
    ASSERT_TRUE(write_png(folder / "a.png", ramp(), depth));
    const auto got = read_rgb_image(folder / "a.png");
    ASSERT_TRUE(got) << got.why().front().message;
    ASSERT_EQ(got->width, 16);
    for (std::size_t i = 0; i < got->samples.size(); ++i)
      ASSERT_NEAR(encoded(got->samples[i]), ramp().samples[i], 2e-6) << i;
  }
}

TEST(ImageFile, PngClampsAndMarksNotANumber) {
  const TemporaryFolder folder;
  RgbImage image(2, 1);
  image.set(0, 0, {-1, 2, 0});
  image.set(1, 0, {std::nanf(""), 0.5f, 0.5f});
  ASSERT_TRUE(write_png(folder / "a.png", image));
  const auto got = read_rgb_image(folder / "a.png");
  EXPECT_EQ(got->samples, (std::vector<float>{0, 1, 0, 1, 0, 1}));
}

TEST(ImageFile, SamePngBytesAndTextInside) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", ramp(), PngDepth::Bits8, {{"marrow/view", "AgX-like"}}));
  ASSERT_TRUE(write_png(folder / "b.png", ramp(), PngDepth::Bits8, {{"marrow/view", "AgX-like"}}));
  EXPECT_EQ(read_text(folder / "a.png"), read_text(folder / "b.png"));
  EXPECT_THAT(read_text(folder / "a.png"), HasSubstr("AgX-like"));
  EXPECT_THAT(read_text(folder / "a.png"), HasSubstr("sRGB"));
}

TEST(ImageFile, EnvironmentsAreReadAsTheyAre) {
  const TemporaryFolder folder;
  Picture p{{0, 0, 2, 1}, {0, 0, 2, 1}, {}, {}};
  p.channels = {{"B", std::vector<float>{3, 1000}},
                {"G", std::vector<float>{2, 0}},
                {"R", std::vector<float>{1, 0}},
                {"Z", std::vector<float>{9, 9}}};
  ASSERT_TRUE(write_exr(folder / "sky.exr", p));
  const auto got = read_rgb_image(folder / "sky.exr");
  ASSERT_TRUE(got);
  EXPECT_EQ(got->samples, (std::vector<float>{1, 2, 3, 0, 0, 1000}));
}

TEST(ImageFile, RefusesPixelsThatAreNotFinite) {
  const TemporaryFolder folder;
  Picture p{{0, 0, 2, 1}, {0, 0, 2, 1}, {}, {}};
  const float inf = std::numeric_limits<float>::infinity();
  for (const char* name : {"B", "G", "R"}) p.channels.push_back({name, std::vector<float>{1, inf}});
  ASSERT_TRUE(write_exr(folder / "sky.exr", p));
  const auto got = read_rgb_image(folder / "sky.exr");
  ASSERT_FALSE(got);
  EXPECT_THAT(got.why().front().message, HasSubstr("(1, 0)"));
}

TEST(ImageFile, RefusesWhatIsNoPicture) {
  const TemporaryFolder folder;
  write_text(folder / "a.png", "P6 1 1 255 abc");
  EXPECT_FALSE(read_rgb_image(folder / "a.png"));
  EXPECT_FALSE(read_rgb_image(folder / "missing.exr"));
  EXPECT_FALSE(read_rgb_image(folder.path()));
  EXPECT_FALSE(read_rgb_image("/dev/zero"));
}

}  // namespace
}  // namespace marrow
