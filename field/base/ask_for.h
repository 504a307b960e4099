// Memory asked for ahead, so that what many rays wait for comes at the same time.
#pragma once

namespace marrow {

/// The cache lines that begin here.
template <int Lines>
inline void ask_for_lines(const void* at) {
  for (int line = 0; line < Lines; ++line) __builtin_prefetch(static_cast<const char*>(at) + 64 * line);
}

}  // namespace marrow
