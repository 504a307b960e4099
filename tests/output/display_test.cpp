// Laws of the display transforms inside the program, on a dozen colours.
#include "renderer/output/display.h"

#include <array>
#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>

#include "field/math/elementary.h"
#include "tests/output/temporary_folder.h"
#include "tests/source_folder.h"

namespace marrow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using Color = std::array<float, 3>;

constexpr std::array<Color, 12> colors = {{{0, 0, 0},
                                           {0.001f, 0.001f, 0.001f},
                                           {0.18f, 0.18f, 0.18f},
                                           {0.5f, 0.5f, 0.5f},
                                           {1, 1, 1},
                                           {1, 0, 0},
                                           {0, 1, 0},
                                           {0, 0, 1},
                                           {0.4f, 0.2f, 0.1f},
                                           {0.05f, 0.3f, 0.6f},
                                           {0.9f, 0.8f, 0.01f},
                                           {0.002f, 0.7f, 0.35f}}};

// IEC 61966-2-1
double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055; }

Display open(const std::string& view, const std::string& space = "lin_rec709_scene") {
  auto display = Display::open({}, "", view, space);
  if (!display) throw std::runtime_error(display.why().front().message);
  return *display;
}

Color show(const Display& display, Color c) {
  display.apply(c);
  return c;
}

class Environment {
 public:
  explicit Environment(const std::string& ocio) { setenv("OCIO", ocio.c_str(), 1); }
  ~Environment() { unsetenv("OCIO"); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
};

std::string embedded_text() { return read_text(test::source_folder() + "/renderer/output/marrow-figures.ocio"); }

TEST(Display, StandardIsTheTransferFunctionOfSrgb) {
  const Display display = open("Standard");
  for (const Color& c : colors) {
    const Color shown = show(display, c);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(shown[k], srgb(c[k]), 1e-5);
  }
}

TEST(Display, StandardIsTheDefaultAndRawChangesNothing) {
  const Display raw = open("Raw"), by_default = open("");
  EXPECT_EQ(by_default.view(), "Standard");
  for (const Color& c : colors) EXPECT_EQ(show(raw, c), c);
}

// To a tenth of an 8-bit code: the rows of the published AgX matrices sum to 1 only within 1.4e-4.
TEST(Display, GreyStaysGreyInEveryView) {
  constexpr double tolerance = 0.1 / 255;
  const std::vector<std::string> views = open("").views();
  ASSERT_FALSE(views.empty());
  for (const std::string& view : views) {
    const Display display = open(view);
    for (float grey = 1e-4f; grey < 20; grey *= 1.7f) {
      const Color shown = show(display, {grey, grey, grey});
      EXPECT_NEAR(shown[0], shown[1], tolerance) << view << " of " << grey;
      EXPECT_NEAR(shown[1], shown[2], tolerance) << view << " of " << grey;
    }
  }
}

// The published polynomial gives 0.5005, 0.7919 and 0.936.
TEST(Display, AgxLikeFollowsAgx) {
  const Display display = open("AgX-like");
  EXPECT_NEAR(show(display, {0.18f, 0.18f, 0.18f})[0], 0.5005, 3e-3);
  EXPECT_NEAR(show(display, {1, 1, 1})[0], 0.7919, 3e-3);
  EXPECT_NEAR(show(display, {4, 4, 4})[0], 0.936, 3e-3);
}

TEST(Display, WhiteOfBothWorkingSpacesIsWhite) {
  const Color shown = show(open("Standard", "lin_ap1_scene"), {1, 1, 1});
  for (const float v : shown) EXPECT_NEAR(v, 1, 1e-4);
  const Color red = show(open("Raw"), show(open("Standard", "lin_ap1_scene"), {0.5f, 0, 0}));
  EXPECT_GT(red[0], srgb(0.5)) << "the red of AP1 lies outside Rec.709";
}

TEST(Display, UnknownViewListsTheViews) {
  const auto display = Display::open({}, "", "Filmic");
  ASSERT_FALSE(display);
  EXPECT_THAT(display.why().front().message, HasSubstr("Filmic"));
  EXPECT_THAT(display.why().front().hint, HasSubstr("AgX-like"));
  EXPECT_FALSE(Display::open({}, "television", ""));
}

TEST(Display, ConfigurationWithoutSceneLinearIsRefused) {
  const TemporaryFolder folder;
  std::string text = embedded_text();
  text.erase(text.find("  scene_linear:"), text.find("  texture_paint:") - text.find("  scene_linear:"));
  write_text(folder / "bad.ocio", text);
  const auto display = Display::open(folder / "bad.ocio", "", "");
  ASSERT_FALSE(display);
  EXPECT_THAT(display.why().front().message, HasSubstr("scene_linear"));
}

TEST(Display, FileWinsOverEnvironmentWinsOverEmbedded) {
  const TemporaryFolder folder;
  const auto named = [&](const std::string& name) {
    std::string text = embedded_text();
    text.replace(text.find("marrow-figures-v1"), std::string("marrow-figures-v1").size(), name);
    write_text(folder / (name + ".ocio"), text);
    return folder / (name + ".ocio");
  };
  EXPECT_THAT(open("").name(), HasSubstr("marrow-figures-v1"));
  const Environment environment(named("from-environment").string());
  EXPECT_THAT(open("").name(), HasSubstr("from-environment"));
  EXPECT_THAT(Display::open(named("from-option"))->name(), HasSubstr("from-option"));
  EXPECT_FALSE(Display::open(folder / "missing.ocio"));
}

// A studio's configuration names its spaces as it likes; the interchange role says what they mean.
TEST(Display, ForeignNamesAreReachedThroughTheInterchangeRole) {
  const TemporaryFolder folder;
  std::string text = embedded_text();
  for (std::size_t at; (at = text.find("lin_rec709_scene")) != std::string::npos;) text.replace(at, 16, "house_linear");
  for (std::size_t at; (at = text.find("scene_linear: house_linear")) != std::string::npos;)
    text.replace(at, 26, "scene_linear: ACEScg");
  write_text(folder / "house.ocio", text);
  const auto foreign = Display::open(folder / "house.ocio", "", "Standard");
  ASSERT_TRUE(foreign) << foreign.why().front().message;
  for (const Color& c : colors)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(show(*foreign, c)[k], srgb(c[k]), 1e-4);
}

TEST(Display, PictureAndItsColorsAgree) {
  const std::size_t n = 10000;
  Picture p{{0, 0, 100, 100}, {0, 0, 100, 100}, {}, {}};
  for (const char* name : {"B", "G", "R"}) p.channels.push_back({name, std::vector<float>(n, 0.25f)});
  const auto image = open("Standard").apply(*rows_of(p));
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->pixel(99, 99)[2], srgb(0.25), 1e-5);
  p.channels.pop_back();
  EXPECT_FALSE(open("Standard").apply(*rows_of(p)));
}

}  // namespace
}  // namespace marrow
