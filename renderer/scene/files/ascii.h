// Names in files, whose letters may be of either case.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace marrow {

/// Letters beyond ASCII stay as they are.
inline std::string lower_case(std::string_view text) {
  std::string made(text);
  for (char& c : made)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return made;
}

/// `.swc` of `cells/CA1.SWC`; empty where there is none.
inline std::string ending_of(const std::string& file) {
  return lower_case(std::filesystem::path(file).extension().string());
}

}  // namespace marrow
