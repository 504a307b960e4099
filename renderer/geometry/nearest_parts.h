// The parts that a ray comes into, a few at a time.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace marrow {

/// Where a ray comes into a part; by solid and part where two are the same.
struct PartEntry {
  double enter = -std::numeric_limits<double>::infinity();  ///< along the ray
  std::uint32_t solid = 0, part = 0;
  friend auto operator<=>(const PartEntry&, const PartEntry&) = default;
};

/// The nearest of the parts it is told of, in whatever order; when they are through, those that follow can be found.
class NearestParts {
 public:
  void add(const PartEntry& entry) {
    if (entry <= before_) return;
    std::uint32_t at = full() ? most - 1 : count_;
    if (full() && entries_[at] < entry) return;
    for (; at > 0 && entry < entries_[at - 1]; --at) entries_[at] = entries_[at - 1];
    entries_[at] = entry;
    if (!full()) ++count_;
  }

  /// There may be others, which begin at `end()` or behind it.
  bool full() const { return count_ == most; }
  double end() const { return full() ? entries_[most - 1].enter : std::numeric_limits<double>::infinity(); }

  /// Null when all have been taken.
  const PartEntry* next() const { return at_ < count_ ? &entries_[at_] : nullptr; }
  void take() { ++at_; }

  /// To be told of those that follow.
  void go_on() {
    before_ = entries_[most - 1];
    count_ = at_ = 0;
  }
  double beginning() const { return before_.enter; }  ///< what begins before it has been taken; -infinity at first

 private:
  // A hit is found in the second part that a ray comes into, on average
  static constexpr std::uint32_t most = 4;
  std::array<PartEntry, most> entries_;
  PartEntry before_;
  std::uint32_t count_ = 0, at_ = 0;
};

}  // namespace marrow
