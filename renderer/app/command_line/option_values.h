// What the values of options mean that are more than a number or a word.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "field/base/result.h"
#include "renderer/app/command_line/commands.h"
#include "renderer/slice/slice.h"

namespace marrow {

/// Seconds, positive: "90s", "10m", "1h30m".
Result<double> parse_time_limit(const std::string&);

/// From 0 to 2^64-1; CLI11 itself would take -1 for the largest.
Result<std::uint64_t> parse_seed(const std::string&);

/// "LOW:HIGH", both finite, LOW < HIGH.
Result<std::pair<double, double>> parse_range(const std::string&);

/// "u0,v0,u1,v1", all finite, u0 < u1, v0 < v1.
Result<SliceWindow> parse_window(const std::string&);

/// "auto", "bar", "plain", "json".
Result<ProgressStyle> parse_progress_style(const std::string&);

}  // namespace marrow
