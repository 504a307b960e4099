// The handler does the one thing that a handler may: it stores into a lock-free atomic.
#include "renderer/app/machine/interrupt.h"

#include <csignal>

namespace marrow {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void set_interrupted(int) { interrupted.store(true, std::memory_order_relaxed); }

bool install_handlers() {
  struct sigaction action = {};
  action.sa_handler = set_interrupted;
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  return sigaction(SIGINT, &action, nullptr) == 0 && sigaction(SIGTERM, &action, nullptr) == 0;
}

}  // namespace

const std::atomic<bool>& interruption_flag() {
  static const bool installed = install_handlers();
  static_cast<void>(installed);
  return interrupted;
}

}  // namespace marrow
