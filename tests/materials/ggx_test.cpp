// Laws of the microfacet distribution [Heitz 2014].
#include "materials/ggx.h"

#include <gtest/gtest.h>

#include "tests/materials/random_directions.h"

namespace marrow {
namespace {

// Integral of `f(h)` over the solid angle of facet normals by midpoints. With tan^2 = alpha^2 t / (1 - t) the share t
// of the facets' projected area is uniform; 1 - t = s^3 puts more points where facets are steep.
template <class F>
double over_normals(double alpha, F f) {
  constexpr int across = 400, around = 400;
  double sum = 0;
  for (int i = 0; i < across; ++i) {
    const double s = (i + 0.5) / across, steep = s * s * s;
    const double mu2 = 1 / (1 + alpha * alpha * (1 - steep) / steep), mu = std::sqrt(mu2);
    // dmu = mu^3 / 2 dtan^2, dtan^2 = alpha^2 / (1 - t)^2 dt, dt = 3 s^2 ds
    const double dmu = mu2 * mu / 2 * alpha * alpha / (steep * steep) * 3 * s * s / across;
    for (int j = 0; j < around; ++j)
      sum += f(direction(mu, 2 * std::numbers::pi * (j + 0.5) / around)) * dmu * (2 * std::numbers::pi / around);
  }
  return sum;
}

TEST(Ggx, FacetsProjectToTheWholeSurface) {
  for (const double alpha : {0.01, 0.1, 0.5, 1.0}) {
    const Ggx ggx(alpha);
    EXPECT_NEAR(over_normals(alpha, [&](const UnitVec3& h) { return ggx.normals(h) * h.z(); }), 1, 1e-5) << alpha;
  }
}

TEST(Ggx, VisibleFacetsProjectToWhatIsSeen) {
  for (const double alpha : {0.1, 0.5, 1.0})
    for (const double mu : {1.0, 0.7, 0.3, 0.1}) {
      const Ggx ggx(alpha);
      const UnitVec3 wo = direction(mu, 0.3);
      const double whole = over_normals(alpha, [&](const UnitVec3& h) {
        return ggx.normals(h) * ggx.shadowing(mu) * std::max(dot(wo, h), 0.0) / mu;
      });
      EXPECT_NEAR(whole, 1, 2e-5) << alpha << ' ' << mu;
    }
}

// The drawn normals have density pdf(wo, h) * 4 (wo.h): means of test functions agree with the integral.
TEST(Ggx, DrawsVisibleFacets) {
  constexpr int n = 1 << 17;
  for (const double alpha : {0.1, 0.5, 1.0})
    for (const double mu : {0.9, 0.2}) {
      const Ggx ggx(alpha);
      const UnitVec3 wo = direction(mu, 0);
      Vec3d mean{}, mean2{};
      for (int i = 0; i < n; ++i) {
        const Vec3d h = ggx.sample_normal(wo, spread(i).xy);
        mean += h / n;
        mean2 += Vec3d{h.x * h.x, h.y * h.y, h.z * h.z} / n;
      }
      const auto expected = [&](auto f) {
        return over_normals(
            alpha, [&](const UnitVec3& h) { return f(h.vec()) * ggx.pdf(wo, h) * 4 * std::max(dot(wo, h), 0.0); });
      };
      EXPECT_NEAR(mean.x, expected([](const Vec3d& h) { return h.x; }), 3e-4) << alpha << ' ' << mu;
      EXPECT_NEAR(mean.z, expected([](const Vec3d& h) { return h.z; }), 3e-4) << alpha << ' ' << mu;
      EXPECT_NEAR(mean2.x, expected([](const Vec3d& h) { return h.x * h.x; }), 3e-4) << alpha << ' ' << mu;
      EXPECT_NEAR(mean2.y, expected([](const Vec3d& h) { return h.y * h.y; }), 3e-4) << alpha << ' ' << mu;
    }
}

TEST(Ggx, SmoothSurfaceMirrors) {
  const Ggx ggx = Ggx::of_roughness(0);
  EXPECT_EQ(ggx.alpha(), Ggx::smallest_alpha);
  const UnitVec3 wo = direction(0.6, 0);
  int close = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto wi = ggx.sample(wo, spread(i).xy);
    ASSERT_TRUE(wi);
    close += length(wi->vec() - Vec3d{-wo.x(), -wo.y(), wo.z()}) < 20 * Ggx::smallest_alpha;
  }
  EXPECT_GT(close, 980);
}

}  // namespace
}  // namespace marrow
