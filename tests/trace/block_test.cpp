// Blocks: both levels are within their stated errors of the exact field, and masks hide no surface.
#include "field/trace/block.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/trace/stage.h"

namespace marrow::test {
namespace {

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const int n : {3, 4, 5, 6})
    for (const double alpha : {0.0, contact_alpha(n), std::numbers::pi / 2, -0.4}) all.push_back({n, alpha});
  return all;
}

PointField field_of(const Stage& stage, const FieldLevel& level, const Block& block, const Vec3d& x) {
  BlockView view = block.view();
  view.fine = level;
  const float local[3] = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)};
  return stage.kernels.point_field(view, local);
}

struct Shares {
  double f = 0, g = 0;  // largest error over what is allowed
};

// Rounding in float: of the position, which the field magnifies by up to n r / d, and of the sums. All in units of
// the sum of norms n f r / d, which bounds |grad_S f| too.
void compare(const Stage& stage, const PointField& found, const Vec3d& p, double half, double f_error, double g_error,
             Shares& shares) {
  const auto exact = sum_of_primitives<Derivatives::ScaleInvariant>(stage.field, p);
  if (!(exact.value < stage.iso.critical_field())) return;  // surely inside: not served
  const double d = found.nearest * half, n = stage.field.degree;
  const double place = 1e-6 * half / d;
  const double f_allowed = f_error + exact.value * (4e-6 + n * place);
  const double g_scale = n * exact.value * largest_radius(stage.field) / d;
  const double g_allowed = g_error + g_scale * (4e-6 + n * place);
  const Vec3d g{found.si_gradient[0], found.si_gradient[1], found.si_gradient[2]};
  const double f_off = std::fabs(found.f - exact.value), g_off = length(g - exact.si_gradient);
  ASSERT_LE(f_off, f_allowed) << "f=" << exact.value << " d/half=" << d / half;
  ASSERT_LE(g_off, g_allowed) << "G=" << length(exact.si_gradient) << " d/half=" << d / half;
  shares.f = std::max(shares.f, f_off / f_allowed);
  shares.g = std::max(shares.g, g_off / g_allowed);
}

TEST(Block, LevelsAreWithinTheirStatedErrors) {
  Random random(61);
  Shares fine, coarse;
  double largest_fine = 0;
  int blocks = 0;
  for (const Setting& s : settings()) {
    const Stage stage(random_scene(random, s, random.whole(2, 12)));
    for (int i = 0; i < 40; ++i, ++blocks) {
      const Block block =
          stage.block(static_cast<std::size_t>(random.whole(0, static_cast<int>(stage.cells.size()) - 1)));
      const BlockView& view = block.view();
      largest_fine = std::max(largest_fine, block.f_error() + block.gradient_error() / s.degree);
      for (int k = 0; k < 25; ++k) {
        const Vec3d x = random.vector(1), p = block.center() + x * block.half();
        compare(stage, field_of(stage, view.fine, block, x), p, block.half(), block.f_error(), block.gradient_error(),
                fine);
        compare(stage, field_of(stage, view.coarse, block, x), p, block.half(),
                static_cast<double>(view.coarse.f_error), static_cast<double>(view.coarse.g_error), coarse);
        if (HasFatalFailure()) return;
      }
    }
  }
  std::cout << "  " << blocks << " blocks; largest error over the allowed: fine f " << fine.f << " grad_S " << fine.g
            << ", coarse f " << coarse.f << " grad_S " << coarse.g << "; largest certified error of C " << largest_fine
            << '\n';
}

TEST(Block, ErrorIsWithinTheTolerance) {
  Random random(62);
  for (const Setting& s : settings()) {
    const Stage stage(random_scene(random, s, 12));
    for (std::size_t i = 0; i < stage.cells.size(); i += 29) {
      const Block block = stage.block(i);
      EXPECT_LT(block.f_error() + block.gradient_error() / s.degree, 1e-5 * (s.degree - 1)) << name_of(s);
    }
  }
}

TEST(Block, MaskHidesNoSurface) {
  Random random(63);
  std::size_t inside = 0, marked = 0, all = 0;
  for (const Setting& s : settings()) {
    const Stage stage(random_scene(random, s, random.whole(2, 9)));
    for (int i = 0; i < 60; ++i) {
      const Block block =
          stage.block(static_cast<std::size_t>(random.whole(0, static_cast<int>(stage.cells.size()) - 1)));
      all += 64;
      marked += static_cast<std::size_t>(__builtin_popcountll(block.mask()));
      for (int k = 0; k < 60; ++k) {
        const Vec3d x = random.vector(1);
        if (stage.value(block.center() + x * block.half()) < 1) continue;
        ++inside;
        const auto at = [](double v) { return std::min(3, static_cast<int>((v + 1) * 2)); };
        ASSERT_TRUE(block.mask() >> (at(x.x) + 4 * at(x.y) + 16 * at(x.z)) & 1) << name_of(s);
      }
    }
  }
  std::cout << "  " << inside << " points inside; " << static_cast<double>(marked) / static_cast<double>(all)
            << " of the sub-cells marked\n";
  EXPECT_GT(inside, 5000U);
}

}  // namespace
}  // namespace marrow::test
