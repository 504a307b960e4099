// Levels of blocks that are not kept: each thread remembers its last ones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "field/trace/levels/block_level.h"
#include "field/trace/levels/level_buffer.h"

namespace marrow {

/// For one thread: the `Count` levels that it has made last, or fewer where these take more than `most_bytes`: then the
/// oldest are freed. What it returns is good until this thread asks again; without a limit, until it has asked for
/// `Count` others.
template <std::size_t Count>
class LevelCache {
 public:
  explicit LevelCache(std::size_t most_bytes = std::numeric_limits<std::size_t>::max()) : most_bytes_(most_bytes) {}

  /// `make(buffer)` returns a BlockLevel that lies in the buffer. `block` is the serial number of the block: the
  /// address of one that is gone may soon be that of another.
  template <class Make>
  const BlockLevel& get(std::uint64_t block, const Make& make) {
    std::uint16_t& place = places_[block * 0x9e3779b97f4a7c15U >> shift];
    if (entries_[place].block == block) return entries_[place].level;
    place = next_;
    next_ = after(next_);
    Entry& entry = entries_[place];
    entry.block = 0;
    bytes_ -= entry.buffer.bytes();
    entry.level = make(entry.buffer);
    bytes_ += entry.buffer.bytes();
    entry.block = block;
    for (std::uint16_t oldest = next_; bytes_ > most_bytes_ && oldest != place; oldest = after(oldest))
      free(entries_[oldest]);
    return entry.level;
  }

  /// Of all levels: `most_bytes` at most, or those of the last one alone.
  std::size_t bytes() const { return bytes_; }

 private:
  static constexpr int bits = 10, shift = 64 - bits;
  struct Entry {
    std::uint64_t block = 0;
    LevelBuffer buffer;
    BlockLevel level;
  };
  static std::uint16_t after(std::uint16_t entry) { return static_cast<std::uint16_t>((entry + 1U) % Count); }
  void free(Entry& entry) {
    bytes_ -= entry.buffer.bytes();
    entry = {};
  }

  std::array<Entry, Count> entries_;
  std::array<std::uint16_t, std::size_t{1} << bits> places_{};  // where a block may be, by its number
  std::uint16_t next_ = 0;
  std::size_t most_bytes_, bytes_ = 0;
};

}  // namespace marrow
