// A value, or the diagnostics that say why there is none.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "field/base/diagnostics.h"

namespace marrow {

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Diagnostics why) : state_(std::move(why)) {}
  Result(Diagnostic why) : state_(Diagnostics{std::move(why)}) {}

  explicit operator bool() const { return std::holds_alternative<T>(state_); }
  T& operator*() { return std::get<T>(state_); }
  const T& operator*() const { return std::get<T>(state_); }
  T* operator->() { return &std::get<T>(state_); }
  const T* operator->() const { return &std::get<T>(state_); }
  /// Only when there is no value.
  const Diagnostics& why() const { return std::get<Diagnostics>(state_); }

 private:
  std::variant<T, Diagnostics> state_;
};

struct Done {};
/// For actions that give nothing but may fail.
using Status = Result<Done>;

/// An error with no place in a text: a file that cannot be read, a device that fails.
inline Diagnostic failure(std::string message, std::string file = {}) {
  return {.where = {.file = std::move(file)}, .message = std::move(message), .hint = {}};
}

}  // namespace marrow
