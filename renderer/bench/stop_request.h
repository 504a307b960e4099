// Somebody may ask the work to stop before it is done.
#pragma once

#include <atomic>

namespace marrow {

/// The flag may be set at any time, also by a signal handler; without a flag nobody asks. What is at work when it is
/// set ends soon, with figures that mean nothing.
struct StopRequest {
  const std::atomic<bool>* flag = nullptr;
  bool is_made() const { return flag != nullptr && flag->load(std::memory_order_relaxed); }
};

}  // namespace marrow
