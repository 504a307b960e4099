// One regular grammar in front of std::from_chars, which alone would take "nan", "1e" and "010".
#include "renderer/scene/scalar.h"

#include <algorithm>
#include <charconv>

#include <fmt/core.h>

#include "renderer/scene/files/ascii.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t count_digits(std::string_view text) {
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) - text.begin());
}

// [-+]? ( digits ( . digits? )? | . digits ) ( [eE] [-+]? digits )?, no leading zero before another digit.
bool is_decimal(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  const std::size_t whole = count_digits(text);
  if (whole > 1 && text[0] == '0') return false;
  text.remove_prefix(whole);
  std::size_t fraction = 0;
  if (!text.empty() && text[0] == '.') {
    text.remove_prefix(1);
    fraction = count_digits(text);
    text.remove_prefix(fraction);
  }
  if (whole + fraction == 0) return false;
  if (text.empty()) return true;
  if (text[0] != 'e' && text[0] != 'E') return false;
  text.remove_prefix(1);
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  return !text.empty() && count_digits(text) == text.size();
}

template <class T>
std::optional<T> whole(std::string_view text) {
  int base = 10;
  if (text.starts_with("0x")) base = 16;
  else if (text.starts_with("0o")) base = 8;
  if (base != 10) text.remove_prefix(2);
  else if (!is_decimal(text)) return std::nullopt;
  if (text.empty() || (base != 10 && text[0] == '-')) return std::nullopt;
  if (text[0] == '+' && base == 10) text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<std::int64_t> parse_integer(std::string_view text) { return whole<std::int64_t>(text); }
std::optional<std::uint64_t> parse_unsigned(std::string_view text) { return whole<std::uint64_t>(text); }

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0o")) {
    const auto integer = parse_integer(text);
    return integer ? std::optional(static_cast<double>(*integer)) : std::nullopt;
  }
  return is_decimal(text) ? finite_number(text) : std::nullopt;
}

std::string number_hint(std::string_view text) {
  const std::string lower = lower_case(text);
  const std::string_view bare = std::string_view(lower).substr(
      lower.find_first_not_of("+-.") == std::string::npos ? 0 : lower.find_first_not_of("+-."));
  if (bare == "nan" || bare == "inf" || bare == "infinity") return "numbers must be finite";
  if (is_decimal(text)) return "a number of this size does not fit; write it within ±1.8e308";
  const bool digits_only = !text.empty() && count_digits(text) == text.size();
  if (digits_only) {
    const std::string trimmed(text.substr(std::min(text.find_first_not_of('0'), text.size() - 1)));
    return "a leading zero means 8 to some readers of YAML and 10 to others; write " + trimmed;
  }
  std::string repaired = lower;
  std::erase(repaired, '_');
  if (repaired != lower && is_decimal(repaired)) return "write " + repaired;
  repaired = lower;
  std::replace(repaired.begin(), repaired.end(), ',', '.');
  if (repaired != lower && is_decimal(repaired)) return "the decimal sign is a point: " + repaired;
  return "";
}

std::string number_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, end) : std::string();
}

std::string numbers_text(double x, double y, double z) {
  return fmt::format("[{}, {}, {}]", number_text(x), number_text(y), number_text(z));
}

}  // namespace marrow
