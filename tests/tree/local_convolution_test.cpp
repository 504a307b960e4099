// Local convolution: places by planes, folds that do not blend, certain enclosures.
#include "field/tree/nodes/local_convolution.h"

#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

struct FieldOf {
  const LocalConvolution& node;
  template <Number X>
  X operator()(const Vec3<X>& p) const {
    return node.value(p);
  }
};

// A coil that comes back near itself, with three radii.
LocalConvolution coil() {
  LocalConvolution c;
  c.radius.clear();
  for (int i = 0; i <= 24; ++i) {
    const double angle = i * 0.45;
    c.points.push_back({std::cos(angle), std::sin(angle), 0.05 * i - 0.6});
    c.radius.push_back(0.15 + 0.002 * i);
  }
  c.reach = 1.2;
  return c;
}
LocalConvolution hairpin(double gap) {
  LocalConvolution c;
  c.points = {{-4, 0, 0}, {3, 0, 0}, {3.4, 0.2 * gap, 0}, {3.4, 0.8 * gap, 0}, {3, gap, 0}, {-4, gap, 0}};
  c.radius = {0.5};
  c.reach = 2;
  return c;
}

std::vector<double> places(const PlaneChain& chain, const Vec3d& p) {
  std::vector<double> all;
  chain.for_each_place(p, [&](double place) { all.push_back(place); });
  return all;
}

TEST(LocalConvolution, PlacesLieOnTheirPlanes) {
  test::Random random(71);
  const LocalConvolution c = coil();
  const PlaneChain chain(c.points);
  int inner = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d p = random.vector(2);
    const auto all = places(chain, p);
    ASSERT_FALSE(all.empty());
    for (const double place : all) {
      if (place == 0 || place == chain.length()) continue;
      const auto k = static_cast<std::size_t>(std::upper_bound(chain.start.begin(), chain.start.end(), place) -
                                              chain.start.begin() - 1);
      const double u = (place - chain.start[k]) / (chain.start[k + 1] - chain.start[k]);
      const Vec3d r = lerp(c.points[k], c.points[k + 1], u), d = lerp(chain.normal[k], chain.normal[k + 1], u);
      EXPECT_NEAR(dot(p - r, d), 0, 1e-8);
      ++inner;
    }
  }
  EXPECT_GT(inner, 3000);
}

TEST(LocalConvolution, WholeWithinReachIsPlainConvolution) {
  test::Random random(72);
  LocalConvolution c = coil();
  c.reach = 1000;
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = random.vector(2);
    double sum = 0;
    for (std::size_t k = 0; k + 1 < c.points.size(); ++k)
      sum += ConvolutionSegment{c.points[k], c.points[k + 1], {c.radius[k], c.radius[k + 1]}}.value(p);
    EXPECT_NEAR(c.value(p), sum, 1e-12 * sum);
  }
}

// Between the legs of a hairpin each leg is on its own; a plain convolution bridges them.
TEST(LocalConvolution, FoldsDoNotBlend) {
  const LocalConvolution c = hairpin(1.3);
  const ConvolutionSegment leg{{-4, 0, 0}, {3, 0, 0}, {0.5}};
  const Vec3d between{-1, 0.65, 0};
  EXPECT_LT(c.value(between), leg.value(between));
  EXPECT_LT(c.value(between), 1);
  EXPECT_GT(2 * leg.value(between), 1);
  EXPECT_NEAR(c.value(Vec3d{-1, 0.3, 0.1}), c.value(Vec3d{-1, 1.0, 0.1}), 1e-12);
}

TEST(LocalConvolution, JointsAreSeamless) {
  test::Random random(73);
  const LocalConvolution c = coil();
  const PlaneChain chain(c.points);
  for (int i = 0; i < 1000; ++i) {
    const auto k = static_cast<std::size_t>(random.whole(1, 23));
    Vec3d v = random.vector(0.3);
    v = v - chain.normal[k] * dot(v, chain.normal[k]);
    const Vec3d p = c.points[k] + v, step = chain.normal[k] * 1e-9;
    EXPECT_NEAR(c.value(p - step), c.value(p + step), 1e-6 * c.value(p));
    EXPECT_NEAR(c.value(p), c.value(p + step), 1e-6 * c.value(p));
  }
}

TEST(LocalConvolution, Laws) {
  const LocalConvolution c = coil(), h = hairpin(1.3);
  LocalConvolution line;
  line.points = {{-1, 0, 0}, {1, 0.3, 0}};
  test::expect_lawful(FieldOf{c}, 74, 2000);
  test::expect_lawful(FieldOf{h}, 75, 2000);
  test::expect_lawful(FieldOf{line}, 76, 500);
}

// Wild polylines with wild radii, whose fields are torn where the place with the largest field vanishes.
TEST(LocalConvolution, LawsHoldAcrossTears) {
  test::Random random(79);
  for (unsigned scene = 0; scene < 40; ++scene) {
    LocalConvolution c;
    c.radius.clear();
    for (int k = 0; k < 4; ++k) {
      c.points.push_back(random.vector(1));
      c.radius.push_back(random.between(0.05, 1));
    }
    c.reach = 0.4;
    test::expect_lawful(FieldOf{c}, 790 + scene, 200);
  }
}

// On the surface, which the tracer has to find, enclosures are small and slopes bounded.
TEST(LocalConvolution, EnclosuresAreTightOnTheSurface) {
  test::Random random(77);
  const LocalConvolution c = coil();
  int bounded = 0, found = 0;
  for (int i = 0; i < 20000 && found < 300; ++i) {
    const Vec3d p = random.vector(1.3);
    const double f = c.value(p);
    if (f < 0.5 || f > 2) continue;
    ++found;
    constexpr double size = 1e-6;
    Vec3<test::Enclosure> box;
    for (std::size_t k = 0; k < 3; ++k) box[k] = test::Enclosure::variable({p[k], p[k] + size}, k);
    const auto e = c.value(box);
    EXPECT_LT(e.value.width(), 1e-3) << p.x << ' ' << p.y << ' ' << p.z;
    bounded += e.slope[0].width() < 0.1 && e.slope[1].width() < 0.1 && e.slope[2].width() < 0.1;
  }
  EXPECT_EQ(found, 300);
  EXPECT_GT(bounded, 290);
}

TEST(LocalConvolution, ExtentHoldsTheLevel) {
  test::Random random(78);
  const LocalConvolution c = coil();
  const Box3 box = c.extent(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p = random.vector(3);
    if (!box.contains(p)) { EXPECT_LT(c.value(p), 1); }
  }
}

TEST(LocalConvolution, RefusesWhatHasNoPlanes) {
  LocalConvolution c = hairpin(1);
  EXPECT_EQ(c.problem(0), "");
  c.radius = {1, 2};
  EXPECT_NE(c.problem(0), "");
  c.radius = {1};
  c.points[1] = c.points[0];
  EXPECT_NE(c.problem(0), "");
}

}  // namespace
}  // namespace marrow
