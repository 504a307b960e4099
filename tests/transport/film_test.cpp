// Sums of samples, and the channels made from them.
#include "renderer/transport/film/film.h"

#include <limits>

#include <gtest/gtest.h>

namespace marrow {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

TEST(PixelSums, HoldMeanAndVarianceOfTheMean) {
  PixelSums pixel;
  for (const double value : {1.0, 2.0, 3.0, 6.0}) pixel.add({.radiance = Rgb(value, 2 * value, 1), .albedo = Rgb(0.5)});
  EXPECT_EQ(pixel.mean(), Rgb(3, 6, 1));
  // sample variance ((-2)^2 + 1 + 0 + 9) / 3 over 4 samples
  EXPECT_NEAR(pixel.variance_of_mean().r, 14.0 / 3 / 4, 1e-12);
  EXPECT_NEAR(pixel.variance_of_mean().g, 4 * 14.0 / 3 / 4, 1e-12);
  EXPECT_EQ(pixel.variance_of_mean().b, 0);
  EXPECT_EQ(pixel.albedo(), Rgb(0.5));
}

TEST(PixelSums, DropAndCountWhatIsNotLight) {
  PixelSums pixel;
  EXPECT_TRUE(pixel.add({.radiance = Rgb(1), .albedo = {}}));
  for (const double bad : {nan, inf, -1e-9}) EXPECT_FALSE(pixel.add({.radiance = Rgb(0, bad, 0), .albedo = {}}));
  EXPECT_EQ(pixel.samples(), 1u);
  EXPECT_EQ(pixel.invalid(), 3u);
  EXPECT_EQ(pixel.mean(), Rgb(1));
}

TEST(Film, ReportsTheFirstPixelWithInvalidSamples) {
  Film film({0, 0, 10, 10}, {2, 3, 6, 8});
  film.at(5, 7).add({.radiance = Rgb(nan), .albedo = {}});
  film.at(3, 6).add({.radiance = Rgb(nan), .albedo = {}});
  film.at(3, 6).add({.radiance = Rgb(nan), .albedo = {}});
  const InvalidSamples found = film.summary().invalid;
  EXPECT_EQ(found.count, 3u);
  EXPECT_EQ(found.x, 3);
  EXPECT_EQ(found.y, 6);
}

TEST(Film, PictureHasTheChannelsThatItsHeaderNames) {
  Film film({0, 0, 3, 2}, {1, 0, 3, 2});
  film.at(2, 1).add({.radiance = Rgb(1, 2, 3), .albedo = Rgb(0.25), .covered = true});
  film.at(2, 1).centre.object = 7;
  film.at(1, 0).centre.certified = false;
  const Picture picture = picture_of(to_rows(film));
  std::string names;
  for (const Channel& c : picture.channels) names += c.name + ' ';
  EXPECT_EQ(names,
            "R G B A Z N.X N.Y N.Z P.X P.Y P.Z albedo.R albedo.G albedo.B variance.R variance.G variance.B object "
            "samples field.evals field.certified ");
  EXPECT_EQ(picture.data, (PixelWindow{1, 0, 3, 2}));
  EXPECT_EQ(std::get<0>(picture.channels[1].samples), (std::vector<float>{0, 0, 0, 2}));
  EXPECT_EQ(std::get<0>(picture.channels[4].samples)[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(std::get<1>(picture.channels[17].samples), (std::vector<std::uint32_t>{0, 0, 0, 7}));
  EXPECT_EQ(std::get<1>(picture.channels.back().samples), (std::vector<std::uint32_t>{0, 1, 1, 1}));
}

}  // namespace
}  // namespace marrow
