// Small readers of text, and words for numbers, that commands share.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marrow {

/// The pieces between separators; as many as there are separators, and one.
std::vector<std::string_view> split(std::string_view, char separator);

/// Seconds of "90", "90s", "10m", "1h30m"; positive.
std::optional<double> parse_duration(std::string_view);

/// "1 object", "2 objects".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace marrow
