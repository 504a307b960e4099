// Colours of known values, and the fit of the black body against tabulated chromaticities.
#include "renderer/scene/colour.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marrow {
namespace {

TEST(Colour, SrgbCodesAreDecoded) {
  const auto orange = parse_srgb("#c89664");
  ASSERT_TRUE(orange);
  EXPECT_NEAR(orange->r, 0.577580, 1e-6);
  EXPECT_NEAR(orange->g, 0.304987, 1e-6);
  EXPECT_NEAR(orange->b, 0.127438, 1e-6);
  EXPECT_EQ(*parse_srgb("#fff"), Rgb(1));
  EXPECT_EQ(*parse_srgb("#000000"), Rgb(0));
  EXPECT_EQ(*parse_srgb("#1A2b3C"), *parse_srgb("#1a2B3c"));
  for (const char* bad : {"c89664", "#c8966", "#c896641", "#gggggg", "#", "#+12345", "#-12", "# 12345"})
    EXPECT_FALSE(parse_srgb(bad)) << bad;
}

// Rec.709 to CIE 1931 xy.
std::pair<double, double> chromaticity(Rgb c) {
  const double x = 0.4123908 * c.r + 0.3575843 * c.g + 0.1804808 * c.b;
  const double y = 0.2126390 * c.r + 0.7151687 * c.g + 0.0721923 * c.b;
  const double z = 0.0193308 * c.r + 0.1191948 * c.g + 0.9505322 * c.b;
  return {x / (x + y + z), y / (x + y + z)};
}

TEST(Colour, BlackBodiesLieOnThePlanckianLocus) {
  struct Known {
    double kelvin, x, y;
  };
  // CIE 1931 chromaticities of Planck's law; 2856 K is illuminant A.
  for (const Known& known : {Known{2856, 0.4476, 0.4074}, Known{4000, 0.3805, 0.3768}, Known{6500, 0.3135, 0.3237},
                             Known{10000, 0.2807, 0.2884}}) {
    const auto [x, y] = chromaticity(black_body_colour(known.kelvin));
    EXPECT_NEAR(x, known.x, 0.001) << known.kelvin;
    EXPECT_NEAR(y, known.y, 0.001) << known.kelvin;
  }
}

TEST(Colour, BlackBodiesHaveLuminanceOneAndTurnBlue) {
  double redness = INFINITY;
  for (double kelvin = 1667; kelvin <= 25000; kelvin *= 1.05) {
    const Rgb c = black_body_colour(kelvin);
    EXPECT_NEAR(luminance(c), 1, 1e-12) << kelvin;
    EXPECT_GE(c.b, 0) << kelvin;
    EXPECT_LT(c.r, redness) << kelvin;
    redness = c.r;
  }
}

}  // namespace
}  // namespace marrow
