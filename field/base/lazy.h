// A value made when it is first asked for, by whichever thread comes first.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace marrow {

/// Two threads may both make it; one copy is kept. So what is made must depend on nothing but what it stands for.
template <class T>
class Lazy {
 public:
  Lazy() = default;
  Lazy(const Lazy&) = delete;
  Lazy& operator=(const Lazy&) = delete;
  ~Lazy() { delete value_.load(std::memory_order_relaxed); }

  /// Null when nobody has asked yet.
  const T* peek() const { return value_.load(std::memory_order_acquire); }

  /// `make()` returns a unique_ptr<const T>.
  template <class Make>
  const T& get(const Make& make) const {
    if (const T* ready = peek()) return *ready;
    std::unique_ptr<const T> made = make();
    const T* expected = nullptr;
    if (value_.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *made.release();
    return *expected;
  }

 private:
  mutable std::atomic<const T*> value_ = nullptr;
};

}  // namespace marrow
