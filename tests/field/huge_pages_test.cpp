// Memory that objects share large pages of: each its own, aligned, and used again.
#include "field/base/huge_pages.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace marrow {
namespace {

struct Small : InHugePages {
  int number = 0;
};
struct alignas(64) Aligned : InHugePages {
  unsigned char bytes[192];
};

std::uintptr_t address(const void* p) { return reinterpret_cast<std::uintptr_t>(p); }

TEST(HugePages, ObjectsOfManyThreadsAreTheirOwn) {
  constexpr int threads = 4, each = 20000;
  std::vector<std::vector<std::unique_ptr<Small>>> made(threads);
  {
    std::vector<std::jthread> running;
    for (int t = 0; t < threads; ++t)
      running.emplace_back([&made, t] {
        for (int i = 0; i < each; ++i) {
          made[static_cast<std::size_t>(t)].push_back(std::make_unique<Small>());
          made[static_cast<std::size_t>(t)].back()->number = t * each + i;
        }
      });
  }
  for (int t = 0; t < threads; ++t)
    for (int i = 0; i < each; ++i)
      ASSERT_EQ(made[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)]->number, t * each + i);
}

TEST(HugePages, ObjectsAreAligned) {
  std::vector<std::unique_ptr<Aligned>> made;
  for (int i = 0; i < 1000; ++i) {
    made.push_back(std::make_unique<Aligned>());
    ASSERT_EQ(address(made.back().get()) % alignof(Aligned), 0U);
    std::memset(made.back()->bytes, i, sizeof made.back()->bytes);
  }
  for (int i = 0; i < 1000; ++i)
    ASSERT_TRUE(std::all_of(std::begin(made[static_cast<std::size_t>(i)]->bytes),
                            std::end(made[static_cast<std::size_t>(i)]->bytes),
                            [i](unsigned char b) { return b == static_cast<unsigned char>(i); }));
}

TEST(HugePages, WhatIsGivenBackServesAgain) {
  const auto first = address(std::make_unique<Aligned>().get());
  bool again = false;
  for (int i = 0; i < 1000 && !again; ++i) again = address(std::make_unique<Aligned>().get()) == first;
  EXPECT_TRUE(again);
}

// Such a one has a chunk of its own, which goes back to the system.
TEST(HugePages, ListsMayBeLong) {
  for (const std::size_t count : {std::size_t{1000}, std::size_t{1} << 22}) {
    std::pmr::vector<std::uint32_t> list(count, 7, &huge_pages());
    EXPECT_EQ(std::count(list.begin(), list.end(), 7U), static_cast<std::ptrdiff_t>(count));
  }
}

TEST(HugePages, ChunksAreAligned) {
  const std::unique_ptr<void, decltype(&std::free)> chunk(allocate_huge(2 * huge_page), &std::free);
  EXPECT_EQ(address(chunk.get()) % huge_page, 0U);
  std::memset(chunk.get(), 1, 2 * huge_page);
}

}  // namespace
}  // namespace marrow
