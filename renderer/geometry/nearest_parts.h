// The parts that a ray comes into, a few at a time.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "renderer/geometry/box_kernels.h"

namespace marrow {

/// Where a ray comes into a part; by solid and part where two are the same.
struct PartEntry {
  static constexpr long long key_of(std::uint32_t solid, std::uint32_t part) {
    return static_cast<long long>(solid) << 32 | part;
  }

  double enter = -std::numeric_limits<double>::infinity();  ///< along the ray
  long long key = 0;                                        ///< of the part, among those of all solids
  std::uint32_t solid() const { return static_cast<std::uint32_t>(key >> 32); }
  std::uint32_t part() const { return static_cast<std::uint32_t>(key); }
  friend auto operator<=>(const PartEntry&, const PartEntry&) = default;
};

/// The nearest parts ahead of a ray; when they are through, those that follow can be found.
class NearestParts {
 public:
  /// What a search has found.
  void set(const RaysAmongBoxes& found, std::size_t lane) {
    count_ = at_ = 0;
    for (std::size_t i = 0; i < most; ++i) {
      entries_[i] = {found.enter[i][lane], found.key[i][lane]};
      count_ += static_cast<std::uint32_t>(entries_[i].key != RaysAmongBoxes::nobody);
    }
  }

  /// There may be others, which begin at `end()` or behind it.
  bool full() const { return count_ == most; }
  double end() const { return full() ? entries_[most - 1].enter : std::numeric_limits<double>::infinity(); }

  /// Null when all have been taken.
  const PartEntry* next() const { return at_ < count_ ? &entries_[at_] : nullptr; }
  void take() { ++at_; }

  /// To be told of those that follow.
  void go_on() {
    taken_ = entries_[most - 1];
    count_ = at_ = 0;
  }
  /// It and what comes before it has been taken; at first nothing has.
  const PartEntry& taken() const { return taken_; }

 private:
  static constexpr std::uint32_t most = RaysAmongBoxes::most;
  std::array<PartEntry, most> entries_;
  PartEntry taken_;
  std::uint32_t count_ = 0, at_ = 0;
};

}  // namespace marrow
