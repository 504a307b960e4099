// Numbers that tell things apart even after they are gone, as addresses do not.
#pragma once

#include <atomic>
#include <cstdint>

namespace marrow {

/// Never 0, and never the same twice in a process.
inline std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> last = 0;
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

}  // namespace marrow
