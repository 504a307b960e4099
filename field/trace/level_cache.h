// Levels of blocks that are not kept: each thread remembers its last ones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

#include "field/trace/block_level.h"

namespace marrow {

/// Room for one level after another, 64-byte aligned.
class LevelBuffer {
 public:
  float* allocate(std::size_t float_count) {
    if (float_count > capacity_) {
      data_.reset(static_cast<float*>(::operator new(float_count * sizeof(float), alignment)));
      capacity_ = float_count;
    }
    return data_.get();
  }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(float* p) const { ::operator delete(p, alignment); }
  };
  std::unique_ptr<float, Free> data_;
  std::size_t capacity_ = 0;
};

/// For one thread: the `Count` levels that it has made last. What it returns is good until this thread asks again.
template <std::size_t Count>
class LevelCache {
 public:
  /// `make(buffer)` returns a BlockLevel that lies in the buffer. `block` is the serial number of the block: the
  /// address of one that is gone may soon be that of another.
  template <class Make>
  const BlockLevel& get(std::uint64_t block, const Make& make) {
    std::uint16_t& place = places_[block * 0x9e3779b97f4a7c15U >> shift];
    if (entries_[place].block == block) return entries_[place].level;
    place = next_;
    next_ = static_cast<std::uint16_t>((next_ + 1U) % Count);
    Entry& entry = entries_[place];
    entry.block = 0;
    entry.level = make(entry.buffer);
    entry.block = block;
    return entry.level;
  }

 private:
  static constexpr int bits = 10, shift = 64 - bits;
  struct Entry {
    std::uint64_t block = 0;
    LevelBuffer buffer;
    BlockLevel level;
  };
  std::array<Entry, Count> entries_;
  std::array<std::uint16_t, std::size_t{1} << bits> places_{};  // where a block may be, by its number
  std::uint16_t next_ = 0;
};

}  // namespace marrow
