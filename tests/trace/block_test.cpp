// Blocks: both levels are within their stated errors of the exact field, and the slots that may hold surface
// leave out no surface.
#include "field/trace/cells/block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <thread>

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

PointField field_of(const Stage& stage, const FieldLevel& level, const Vec3d& x) {
  const PlacesInLanes local{{{static_cast<float>(x.x)}, {static_cast<float>(x.y)}, {static_cast<float>(x.z)}}};
  PointField found;
  stage.kernels.point_fields(level, stage.field.degree, local, 1, &found);
  return found;
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

// In lanes or one by one: the same bits.
TEST(Block, FieldsOfPlacesTogetherAreThoseOfEach) {
  Random random(67);
  for (const char* set : {"sse4", "avx2", "avx512"}) {
    if (block_kernels(set) == nullptr) continue;  // not on this machine
    for (const Setting& s : settings()) {
      const Stage stage(random_scene(random, s, random.whole(2, 40)), set);
      const Block block = stage.block(0);
      for (const int count : {2, 9, 16}) {
        PlacesInLanes places;
        for (auto& of_axis : places.at)
          for (float& x : of_axis) x = static_cast<float>(random.between(-1, 1));
        std::array<PointField, lanes> together;
        stage.kernels.point_fields(block.fine().level, s.degree, places, count, together.data());
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
          const Vec3d x{places.at[0][i], places.at[1][i], places.at[2][i]};
          const PointField alone = field_of(stage, block.fine().level, x);
          ASSERT_EQ(std::memcmp(&together[i], &alone, sizeof alone), 0) << set << " " << count << " " << i;
        }
      }
    }
  }
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
      const BlockLevel& traced = block.fine();
      const FieldLevel& rough = block.coarse().level;
      largest_fine = std::max(largest_fine, traced.f_error + traced.gradient_error / s.degree);
      for (int k = 0; k < 25; ++k) {
        const Vec3d x = random.vector(1), p = block.center() + x * block.half();
        compare(stage, field_of(stage, traced.level, x), p, block.half(), traced.f_error, traced.gradient_error, fine);
        compare(stage, field_of(stage, rough, x), p, block.half(), static_cast<double>(rough.f_error),
                static_cast<double>(rough.g_error), coarse);
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
      const BlockLevel& fine = block.fine();
      EXPECT_LT(fine.f_error + fine.gradient_error / s.degree, 1e-5 * (s.degree - 1)) << name_of(s);
    }
  }
}

// Of a segment between a point outside and one inside.
Vec3d surface_between(const Stage& stage, const Block& block, Vec3d outside, Vec3d inside) {
  for (int i = 0; i < 30; ++i) {
    const Vec3d middle = (outside + inside) * 0.5;
    (stage.value(block.center() + middle * block.half()) < 1 ? outside : inside) = middle;
  }
  return inside;
}

// Whether the slot of x, in block coordinates, may hold surface, and the eighth of it.
bool may_hold(const Block& block, const Vec3d& x) {
  int octant = 0, slot = 0, eighth = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = std::clamp(static_cast<int>(std::floor(8 * x[k] + 8)), 0, 15);
    octant |= i >> 3 << k;
    slot |= (i >> 1 & 3) << (2 * k);
    eighth |= (i & 1) << k;
  }
  if (!(block.view().surface(octant) >> slot & 1)) return false;
  return block.view().eighths_of(64 * octant + slot) >> eighth & 1;
}

TEST(Block, SlotsAndEighthsHoldAllSurface) {
  Random random(63);
  int surface = 0;
  double slots = 0, eighths = 0, blocks = 0;
  for (const Setting& s : settings()) {
    const Stage stage(random_scene(random, s, random.whole(2, 9)));
    for (int i = 0; i < 60; ++i) {
      const Block block =
          stage.block(static_cast<std::size_t>(random.whole(0, static_cast<int>(stage.cells.size()) - 1)));
      for (int k = 0; k < 40; ++k) {
        Vec3d a = random.vector(1), b = random.vector(1);
        const auto value = [&](const Vec3d& x) { return stage.value(block.center() + x * block.half()); };
        if (value(a) >= 1) std::swap(a, b);
        if (value(a) >= 1 || value(b) < 1) continue;
        const Vec3d x = surface_between(stage, block, a, b);
        ++surface;
        ASSERT_TRUE(may_hold(block, x)) << name_of(s);
      }
      for (int octant = 0; octant < 8; ++octant) slots += std::popcount(block.view().surface(octant));
      for (int slot = 0; slot < slots_of_block && !block.empty(); ++slot)
        eighths += std::popcount(static_cast<unsigned>(block.view().eighths_of(slot)));
      ++blocks;
    }
  }
  std::cout << "  " << surface << " points of surface; slots of a block that may hold some: " << slots / blocks
            << ", their eighths: " << eighths / blocks << '\n';
  EXPECT_GT(surface, 2000);
  EXPECT_LT(eighths, 0.85 * 8 * slots);  // cells are small here: what coarse levels neglect is half an eighth
}

// What a thread remembers of a block that is gone must not be taken for that of one at its address.
TEST(Block, LevelsThatAreNotKeptAreNeverThoseOfAnotherBlock) {
  Random random(63);
  const Stage stage(random_scene(random, {4, contact_alpha(4)}, 8));
  Block::Context nothing_kept = stage.context;
  nothing_kept.kept_bytes = 0;
  std::optional<Block> here;
  for (std::size_t i = 0; i < std::min<std::size_t>(stage.cells.size(), 50); ++i) {
    here.emplace(nothing_kept, stage.cells[i]);
    const Block kept = stage.block(i);
    for (const auto level : {&Block::coarse, &Block::fine}) {
      const FieldLevel &a = (*here.*level)().level, &b = (kept.*level)().level;
      ASSERT_EQ(a.curve_groups, b.curve_groups) << "cell " << i;
      const std::size_t floats = 4 * monomials_to_degree(b.far_degree);
      ASSERT_TRUE(std::equal(a.far, a.far + floats, b.far)) << "cell " << i;
    }
  }
}

// Another thread finds what the first one has left, and makes the levels of it.
TEST(Block, CompactLevelsHaveTheBitsOfThoseThatAreKept) {
  Random random(64);
  int cut_pieces = 0, levels = 0;
  for (const Setting& s : settings()) {
    const Stage stage(random_scene(random, s, 8));
    Block::Context compact = stage.context;
    compact.kept_bytes = 0;
    compact.compact_bytes = std::size_t{1} << 30;
    for (std::size_t i = 0; i < stage.cells.size(); i += 1 + stage.cells.size() / 20) {
      const Block kept = stage.block(i), told(compact, stage.cells[i]);
      if (kept.empty()) continue;
      told.fine();
      for (const auto level : {&Block::coarse, &Block::fine}) {
        const FieldLevel& expected = (kept.*level)().level;
        std::thread([&] {
          const FieldLevel& found = (told.*level)().level;
          const auto groups = static_cast<std::size_t>(expected.curve_groups + expected.point_groups);
          ASSERT_EQ(found.curve_groups, expected.curve_groups);
          ASSERT_EQ(found.point_groups, expected.point_groups);
          EXPECT_TRUE(std::equal(found.sources, found.sources + groups * floats_per_group, expected.sources));
          EXPECT_TRUE(std::equal(found.far, found.far + 4 * monomials_to_degree(expected.far_degree), expected.far));
          EXPECT_EQ(found.f_error, expected.f_error);
          EXPECT_EQ(found.far_g_bend, expected.far_g_bend);
          cut_pieces += groups > 8;
          ++levels;
        }).join();
      }
      ASSERT_NE(told.fine_if_kept(), nullptr);
      EXPECT_EQ(told.fine_if_kept()->level.curve_groups, kept.fine().level.curve_groups);
      EXPECT_EQ(told.fine_if_kept()->f_error, kept.fine().f_error);
    }
  }
  EXPECT_GT(levels, 50);
  EXPECT_GT(cut_pieces, 5);
}

}  // namespace
}  // namespace marrow::test
