#include "renderer/output/exr_header.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include <fmt/format.h>

namespace marrow {
namespace {

// As the EXR standard writes dates.   [https://reproducible-builds.org/specs/source-date-epoch/]
Result<std::string> capture_date() {
  std::time_t when = std::time(nullptr);
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) {
    const std::string_view text(epoch);
    long long seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (error != std::errc{} || end != text.data() + text.size())
      return failure("SOURCE_DATE_EPOCH is \"" + std::string(text) + "\", not a whole number of seconds");
    when = static_cast<std::time_t>(seconds);
  }
  std::tm t{};
  if (!gmtime_r(&when, &t)) return failure("SOURCE_DATE_EPOCH is beyond the calendar");
  return fmt::format("{:04}:{:02}:{:02} {:02}:{:02}:{:02}", t.tm_year + 1900, t.tm_mon + 1, t.tm_mday, t.tm_hour,
                     t.tm_min, t.tm_sec);
}

}  // namespace

Result<HeaderEntries> header_entries(const PictureRows& picture) {
  const Result<std::string> date = capture_date();
  if (!date) return date.why();
  const bool has_color = std::ranges::any_of(picture.channels, [](const auto& c) { return c.name == "R"; });
  HeaderEntries entries{{"Software", std::string("marrow " MARROW_VERSION)},
                        {"capDate", *date},
                        {"colorInteropID", std::string(has_color ? "lin_rec709_scene" : "data")}};
  for (const auto& [name, value] : picture.metadata) entries.insert_or_assign(name, value);
  return entries;
}

}  // namespace marrow
