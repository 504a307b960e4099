// Command lines of programs that take numbers only: --name N, any of them, in any order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

namespace marrow::test {

struct NumberOption {
  std::string_view name;
  std::uint64_t& value;
};

/// Whether all arguments were known, each with a value.
inline bool read_numbers(int argc, char** argv, std::span<const NumberOption> options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const auto option = std::ranges::find(options, std::string_view(argv[i]), &NumberOption::name);
    if (option == options.end()) return false;
    option->value = std::strtoull(argv[i + 1], nullptr, 10);
  }
  return argc % 2 == 1;
}

}  // namespace marrow::test
