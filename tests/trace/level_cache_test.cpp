// The cache of levels gives what was made for a block, makes it once while it has room, and stays within its bytes.
#include "field/trace/levels/level_cache.h"

#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/field/random.h"

namespace marrow::test {
namespace {

// What tells levels apart, in their memory.
BlockLevel make_level(LevelBuffer& buffer, std::uint64_t block, std::size_t floats) {
  float* const at = buffer.allocate(floats);
  at[0] = static_cast<float>(block);
  BlockLevel made;
  made.level.sources = at;
  return made;
}

TEST(LevelCache, MakesALevelOnceWhileItIsAmongTheLast) {
  LevelCache<4> cache;
  int made = 0;
  const auto get = [&](std::uint64_t block) {
    return cache.get(block, [&](LevelBuffer& buffer) { return ++made, make_level(buffer, block, 16); })
        .level.sources[0];
  };
  for (int round = 0; round < 3; ++round)
    for (const std::uint64_t block : {1, 2, 3, 4}) EXPECT_EQ(get(block), static_cast<float>(block));
  EXPECT_EQ(made, 4);
  EXPECT_EQ(get(5), 5.0F);
  EXPECT_EQ(get(1), 1.0F);
  EXPECT_EQ(made, 6);
}

TEST(LevelCache, StaysWithinItsBytes) {
  constexpr std::size_t most_bytes = 1 << 14;
  LevelCache<64> cache(most_bytes);
  Random random(14);
  for (int i = 0; i < 20'000; ++i) {
    const auto block = static_cast<std::uint64_t>(random.whole(1, 100));
    const auto floats = static_cast<std::size_t>(random.whole(1, 1'000));
    const BlockLevel& level = cache.get(block, [&](LevelBuffer& buffer) { return make_level(buffer, block, floats); });
    ASSERT_EQ(level.level.sources[0], static_cast<float>(block));
    ASSERT_LE(cache.bytes(), most_bytes);
  }
}

TEST(LevelCache, KeepsTheLastLevelHoweverLarge) {
  LevelCache<8> cache(1'000);
  for (std::uint64_t block = 1; block < 20; ++block) {
    const BlockLevel& level = cache.get(block, [&](LevelBuffer& buffer) { return make_level(buffer, block, 5'000); });
    ASSERT_EQ(level.level.sources[0], static_cast<float>(block));
    ASSERT_EQ(cache.bytes(), 5'000 * sizeof(float));
  }
}

}  // namespace
}  // namespace marrow::test
