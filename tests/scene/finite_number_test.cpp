// What is read is what was meant, and nothing else is read.
#include "renderer/scene/finite_number.h"

#include <gtest/gtest.h>

namespace marrow {
namespace {

TEST(FiniteNumber, ReadsWholeNumbersAndNothingBeside) {
  EXPECT_EQ(finite_number("-1.5e2"), -150);
  EXPECT_EQ(finite_number("+3"), 3);
  for (const auto* wrong : {"", "+", "+-1", "++1", "1 ", " 1", "1x", "nan", "+inf", "inf", "1e999", "0x10", "1,5"})
    EXPECT_FALSE(finite_number(wrong)) << wrong;
}

}  // namespace
}  // namespace marrow
