// Laws of slices: places, numbers, lines and errors.
#include "renderer/slice/slice.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "renderer/output/colormap.h"
#include "renderer/slice/figure.h"

namespace marrow {
namespace {

// (1/|p|)^3: the field of a point skeleton of radius 1, a pole at the origin.
SliceSample ball(const Vec3d& p) {
  const double r = length(p);
  return {1 / (r * r * r), p * (-3 / (r * r * r * r * r))};
}

const Box3 unit_box{{-1, -1, -1}, {1, 1, 1}};

SliceImage slice_ball(int width, const SliceRequest& request = {}) {
  SliceRequest r = request;
  r.width = width;
  const auto image = slice({ball}, 1, unit_box, r);
  if (!image) throw std::runtime_error(image.why().front().message);
  return *image;
}

// The values of a field that tells where it was asked.
SliceSample where(const Vec3d& p) { return {p.x + 100 * p.y + 10000 * p.z, {}}; }

TEST(Slice, PixelCentersOfEachPlaneWithVUp) {
  const SliceWindow window{0, 0, 2, 1};
  const double expected[] = {10000 * 0.5 + 100 * 1.5 + 7, 10000 * 0.5 + 100 * 7 + 1.5, 10000 * 7 + 100 * 0.5 + 1.5};
  for (int axis = 0; axis < 3; ++axis) {
    SliceRequest request{.axis = axis, .offset = 7, .window = window, .range = {}};
    request.width = 2;
    const auto image = slice({where}, 1, unit_box, request);
    ASSERT_TRUE(image);
    ASSERT_EQ(image->height, 1);
    EXPECT_DOUBLE_EQ(image->at(1, 0).value, expected[axis]);
  }
  SliceRequest tall{.window = SliceWindow{0, 0, 1, 2}, .range = {}};
  tall.width = 1;
  EXPECT_DOUBLE_EQ(slice({where}, 1, unit_box, tall)->at(0, 0).value, 0.5 + 150) << "the first row is the upper one";
}

// A field that tells how small the box was in which it was asked; NaN outside of it.
SliceField asked_in(const Box3& box) {
  return {.at =
              [box](const Vec3d& p) {
                return SliceSample{box.contains(p) ? max_component(box.size()) : NAN, {}};
              },
          .within =
              [box](const Box3& inner) {
                return asked_in(box.contains(inner.lower) && box.contains(inner.upper) ? inner : Box3{});
              }};
}

TEST(Slice, AsksForFieldsInBoxesInBoxesAroundTheirPixels) {
  for (const int width : {1, 7, 16, 17, 300}) {
    const SliceWindow window{-1, -0.5, 1, 0.5};
    SliceRequest request{.window = window, .range = {}};
    request.width = width;
    const Box3 all{{-2, -2, -2}, {2, 2, 2}};
    const auto image = slice(asked_in(all), 1, unit_box, request);
    ASSERT_TRUE(image);
    for (const SliceSample& s : image->samples) {
      const double largest = width > 16 ? 16 * image->units_per_pixel() : 4;
      EXPECT_LE(s.value, largest + 1e-12) << "of a width of " << width;
    }
  }
}

TEST(Slice, DefaultWindowHoldsTheObjectAndAQuarterAround) {
  const SliceImage image = slice_ball(64);
  EXPECT_EQ(image.window.u0, -1.5);
  EXPECT_EQ(image.window.v1, 1.5);
  EXPECT_EQ(image.height, 64);
}

TEST(Slice, SameForAnyNumberOfThreads) {
  SliceRequest one, two;
  one.threads = 1;
  two.threads = 2;
  EXPECT_TRUE(to_exr_picture(slice_ball(100, one)).channels[3].samples ==
              to_exr_picture(slice_ball(100, two)).channels[3].samples);
}

TEST(Slice, ExrKeepsTheRawNumbers) {
  const SliceImage image = slice_ball(32);
  const Picture picture = to_exr_picture(image);
  ASSERT_EQ(picture.channels.size(), 4u);
  EXPECT_EQ(picture.channels[3].name, "field.value");
  EXPECT_EQ(std::get<std::vector<float>>(picture.channels[3].samples)[5], static_cast<float>(image.at(5, 0).value));
  EXPECT_EQ(std::get<std::vector<float>>(picture.channels[0].samples)[5],
            static_cast<float>(image.at(5, 0).gradient.x));
}

// White exactly along the circle of radius 1, and not at the pole, where |f - iso| / |grad f| vanishes too.
TEST(Slice, SurfaceLineFollowsTheSurface) {
  const SliceImage image = slice_ball(301);
  const auto painted = paint(image, {.range = {}, .units = {}, .contours = false, .legend = false});
  ASSERT_TRUE(painted);
  const Colormap viridis = *Colormap::named("viridis");
  int white = 0;
  for (int y = 0; y < 301; ++y)
    for (int x = 0; x < 301; ++x) {
      const double radius = std::hypot((x - 150) * 0.01 * 300 / 301, (y - 150) * 0.01 * 300 / 301);
      const float* p = painted->pixel(x, y);
      const bool is_white = p[0] > 0.95f && p[1] > 0.95f && p[2] > 0.95f;
      white += is_white;
      if (is_white) { ASSERT_NEAR(radius, 1, 0.02) << x << " " << y; }
      if (std::fabs(radius - 1) > 0.05) { ASSERT_EQ(p[0], viridis(image.at(x, y).value / 2)[0]) << x << " " << y; }
    }
  EXPECT_GT(white, 300) << "of the 628 pixels of the circle's length";
}

// Towards the pole the field rises so fast that |f - 1| / |grad f| hardly grows.
TEST(Slice, SurfaceLineIsAsWideInsideAsOutside) {
  const SliceImage image = slice_ball(300, {.window = SliceWindow{-15, -15, 15, 15}, .range = {}});
  const auto painted = paint(image, {.range = {}, .units = {}, .contours = false, .legend = false});
  const Colormap map = *Colormap::named("viridis");
  const double widest = 5.5 * figure_scale(300) / 2 + 0.5;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 300; ++x) {
      const double from_surface = std::fabs(std::hypot(x - 149.5, y - 149.5) - 10);
      const bool is_plain = painted->pixel(x, y)[0] == map(image.at(x, y).value / 2)[0];
      if (std::fabs(from_surface - widest) > 0.2) { ASSERT_EQ(is_plain, from_surface > widest) << x << ' ' << y; }
    }
}

TEST(Slice, NoLineWhereBoundedFieldsEnd) {
  const auto bounded = [](const Vec3d& p) { return SliceSample{std::fmax(0, 2 - 2 * length(p)), {}}; };
  const SliceImage image =
      *slice({bounded}, 1, unit_box, {.window = SliceWindow{-2, -2, 2, 2}, .width = 200, .range = {}});
  const auto painted = paint(image, {.range = {}, .units = {}, .contours = true, .legend = false});
  const Colormap map = *Colormap::named("viridis");
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      if (image.at(x, y).value < 0.15) { ASSERT_EQ(painted->pixel(x, y)[0], map(image.at(x, y).value / 2)[0]); }
}

TEST(Slice, NotANumberIsMagentaAndInfinityTheEndColour) {
  SliceImage image = slice_ball(33);
  image.samples[0].value = std::nan("");
  image.samples[16 * 33 + 16].value = std::numeric_limits<double>::infinity();
  const auto painted = paint(image, {.range = {}, .units = {}, .contours = false, .legend = false});
  EXPECT_EQ(painted->pixel(0, 0)[1], 0.f);
  EXPECT_EQ(painted->pixel(0, 0)[2], 1.f);
  EXPECT_EQ(painted->pixel(16, 16)[0], (*Colormap::named("viridis"))(1)[0]);
}

TEST(Slice, AutomaticRangeHasTheSurfaceInItsMiddle) {
  SliceImage image = slice_ball(32);
  EXPECT_EQ(automatic_range(image), std::pair(0.0, 2.0));
  image.samples[3].value = -1e9;
  EXPECT_EQ(automatic_range(image).first, -1.0);
  image.iso = 0;
  image.samples.assign(image.samples.size(), {});
  EXPECT_LT(automatic_range(image).first, automatic_range(image).second);
}

TEST(Slice, LegendGrowsThePictureOfEveryShape) {
  for (const SliceWindow& w : {SliceWindow{0, 0, 1, 1}, SliceWindow{0, 0, 1e-7, 1e-9}, SliceWindow{-1e6, 0, 0, 4e6}}) {
    SliceRequest request{.window = w, .range = {}};
    request.width = 100;
    const auto image = slice({ball}, 1, unit_box, request);
    ASSERT_TRUE(image);
    const auto painted = paint(*image, {.range = {}, .units = "µm"});
    ASSERT_TRUE(painted);
    EXPECT_GT(painted->width, image->width);
    EXPECT_GT(painted->height, image->height);
  }
}

TEST(Slice, RefusesWhatHasNoPicture) {
  SliceRequest request;
  EXPECT_FALSE(slice({ball}, 1, Box3{}, request)) << "no bounds";
  request.window = SliceWindow{0, 0, 0, 1};
  EXPECT_FALSE(slice({ball}, 1, unit_box, request)) << "no width";
  request.window = SliceWindow{0, 0, 1, INFINITY};
  EXPECT_FALSE(slice({ball}, 1, unit_box, request)) << "infinite";
  request.window = SliceWindow{0, 0, 1, 1e6};
  EXPECT_FALSE(slice({ball}, 1, unit_box, request)) << "too many pixels";
  EXPECT_FALSE(paint(slice_ball(4), {.range = std::pair(1.0, 1.0), .units = {}}));
  EXPECT_FALSE(paint(slice_ball(4), {.range = {}, .colormap = "jet", .units = {}}));
}

TEST(Slice, PlanesAreParsedOrRefused) {
  EXPECT_EQ(*parse_plane("z=0"), std::pair(2, 0.0));
  EXPECT_EQ(*parse_plane(" x = -1.5e2"), std::pair(0, -150.0));
  for (const char* bad : {"", "z", "z=", "w=1", "z=1x", "z=nan", "z=inf", "z==1", "0=z"})
    EXPECT_FALSE(parse_plane(bad)) << bad;
}

}  // namespace
}  // namespace marrow
