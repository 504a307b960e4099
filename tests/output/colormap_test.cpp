// Laws of false colour.
#include "renderer/output/colormap.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marrow {
namespace {

using Color = std::array<float, 3>;

Color bytes(int r, int g, int b) { return {float(r) / 255, float(g) / 255, float(b) / 255}; }

TEST(Colormap, ViridisHasItsPublishedEnds) {
  const Colormap viridis = *Colormap::named("viridis");
  EXPECT_EQ(viridis(0), bytes(0x44, 0x01, 0x54));
  EXPECT_EQ(viridis(1), bytes(0xfd, 0xe7, 0x25));
  EXPECT_EQ(viridis(128 / 255.0), bytes(0x21, 0x91, 0x8c));
}

TEST(Colormap, ClampsAndMarksNotANumber) {
  for (const std::string& name : Colormap::names()) {
    const Colormap map = *Colormap::named(name);
    EXPECT_EQ(map(-INFINITY), map(0)) << name;
    EXPECT_EQ(map(INFINITY), map(1)) << name;
    EXPECT_EQ(map(NAN), (Color{1, 0, 1})) << name;
  }
}

TEST(Colormap, NeverJumps) {
  for (const std::string& name : Colormap::names()) {
    const Colormap map = *Colormap::named(name);
    for (int i = 0; i < 5000; ++i) {
      const Color a = map(i / 5000.0), b = map((i + 1) / 5000.0);
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(a[k], b[k], 0.004) << name << " at " << i;
    }
  }
}

TEST(Colormap, UnknownNameListsTheKnown) {
  const auto map = Colormap::named("jet");
  ASSERT_FALSE(map);
  EXPECT_NE(map.why().front().hint.find("viridis"), std::string::npos);
}

}  // namespace
}  // namespace marrow
