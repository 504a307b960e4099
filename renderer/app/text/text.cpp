// Pieces are views; nothing is copied.
#include "renderer/app/text/text.h"

#include <algorithm>

#include <fmt/format.h>

#include "renderer/scene/finite_number.h"

namespace marrow {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (auto at = text.find(separator); at != std::string_view::npos; at = text.find(separator)) {
    parts.push_back(text.substr(0, at));
    text.remove_prefix(at + 1);
  }
  parts.push_back(text);
  return parts;
}

std::optional<double> parse_duration(std::string_view text) {
  constexpr std::string_view units = "hms";
  constexpr double seconds[] = {3600, 60, 1};
  double total = 0;
  std::size_t next_unit = 0;  // hours before minutes before seconds, each at most once
  while (!text.empty()) {
    const auto length = std::min(text.find_first_of(units), text.size());
    const auto value = finite_number(text.substr(0, length));
    const auto unit = length < text.size() ? units.find(text[length]) : units.find('s');
    if (!value || *value < 0 || unit < next_unit) return std::nullopt;
    total += *value * seconds[unit];
    next_unit = unit + 1;
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return total > 0 ? std::optional(total) : std::nullopt;
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace marrow
