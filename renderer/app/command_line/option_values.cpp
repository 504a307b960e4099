// A text that does not say what it should is told what it should say.
#include "renderer/app/command_line/option_values.h"

#include <vector>

#include "renderer/app/text/text.h"
#include "renderer/scene/finite_number.h"
#include "renderer/scene/scalar.h"

namespace marrow {

Result<double> parse_time_limit(const std::string& text) {
  if (const auto seconds = parse_duration(text)) return *seconds;
  return failure("a time is 90s, 10m or 1h30m; found '" + text + "'");
}

Result<std::uint64_t> parse_seed(const std::string& text) {
  if (const auto number = parse_unsigned(text)) return *number;
  return failure("a seed is a whole number from 0 to 2^64-1; found '" + text + "'");
}

Result<std::pair<double, double>> parse_range(const std::string& text) {
  const auto parts = split(text, ':');
  if (parts.size() == 2) {
    const auto low = finite_number(parts[0]), high = finite_number(parts[1]);
    if (low && high && *low < *high) return std::pair{*low, *high};
  }
  return failure("a range is LOW:HIGH with LOW < HIGH; found '" + text + "'");
}

Result<SliceWindow> parse_window(const std::string& text) {
  const auto parts = split(text, ',');
  std::vector<double> edges;
  for (const auto part : parts)
    if (const auto edge = finite_number(part)) edges.push_back(*edge);
  if (parts.size() == 4 && edges.size() == 4 && edges[0] < edges[2] && edges[1] < edges[3])
    return SliceWindow{edges[0], edges[1], edges[2], edges[3]};
  return failure("a window is u0,v0,u1,v1 in scene units with u0 < u1 and v0 < v1; found '" + text + "'");
}

Result<ProgressStyle> parse_progress_style(const std::string& text) {
  if (text == "auto") return ProgressStyle::Auto;
  if (text == "bar") return ProgressStyle::Bar;
  if (text == "plain") return ProgressStyle::Plain;
  if (text == "json") return ProgressStyle::Json;
  return failure("a style is auto, bar, plain or json; found '" + text + "'");
}

}  // namespace marrow
