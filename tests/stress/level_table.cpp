// Brackets of the curve where the operator is at a level, step by step in f.
#include "tests/stress/level_table.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace marrow::test {
namespace {

constexpr double largest_f = 8, steps_per_unit = 512;
// Over the largest G that counts; the curve moves by more over a step.
constexpr double bracket_width = 5e-4;

}  // namespace

LevelTable::LevelTable(const Correction& correction, double level)
    : correction_(correction), level_(level), ends_(static_cast<std::size_t>(largest_f * steps_per_unit) + 1) {}

LevelTable::Bracket LevelTable::made(double f) const {
  if (!(correction_.value(f, 0) < level_)) return {-1, 0, true};
  // On the reference curve G is n - 1 where f is 1, and no sum is far above that curve.
  const double steepest = correction_.degree() - 1;
  Bracket found{0, 4 * steepest, true};
  if (correction_.value(f, found.above) < level_) return {found.above, std::numeric_limits<double>::infinity(), true};
  while (found.above - found.below > bracket_width * steepest) {
    const double middle = 0.5 * (found.below + found.above);
    (correction_.value(f, middle) < level_ ? found.below : found.above) = middle;
  }
  return found;
}

const LevelTable::Bracket& LevelTable::at_end(std::size_t i) const {
  if (!ends_[i].is_made) ends_[i] = made(static_cast<double>(i) / steps_per_unit);
  return ends_[i];
}

LevelTable::Bracket LevelTable::around(double f) const {
  const auto i = static_cast<std::size_t>(f * steps_per_unit);
  const Bracket &first = at_end(i), &second = at_end(i + 1);
  return {std::min(first.below, second.below), std::max(first.above, second.above)};
}

bool LevelTable::is_below(double f, double G) const {
  if (!(f >= 0 && f < largest_f)) return correction_.value(f, G) < level_;
  const Bracket step = around(f);
  return G <= step.below || (G < step.above && correction_.value(f, G) < level_);
}

bool LevelTable::is_above(double other, double f, double G) const {
  if (f >= 0 && f < largest_f && G >= around(f).above) return true;
  return correction_.value(f, G) > other;
}

}  // namespace marrow::test
