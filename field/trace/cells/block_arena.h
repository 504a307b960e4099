// Memory for blocks: chunks, soon large ones, handed out front to back, freed all at once.
// Blocks come by the ten thousand while rays wait; one page fault for each 4 KiB of them costs more than filling them.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace marrow {

/// Safe to use from many threads.
class BlockArena {
 public:
  /// 64-byte aligned, not initialised; lives as long as the arena. Throws std::bad_alloc.
  float* allocate(std::size_t float_count);
  /// Of its chunks, used or not.
  std::size_t bytes() const;
  /// Of all arenas of the process together.
  static std::size_t bytes_of_all() { return all_.load(std::memory_order_relaxed); }
  ~BlockArena() { all_ -= total_; }
  BlockArena() = default;
  BlockArena(const BlockArena&) = delete;
  BlockArena& operator=(const BlockArena&) = delete;

 private:
  struct Free {
    void operator()(void*) const;
  };
  using Chunk = std::unique_ptr<void, Free>;
  mutable std::mutex mutex_;
  std::vector<Chunk> chunks_;
  std::byte* next_ = nullptr;
  std::size_t left_ = 0, total_ = 0;
  static inline std::atomic<std::size_t> all_ = 0;
};

}  // namespace marrow
