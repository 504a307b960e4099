// Numbers of YAML 1.2's core schema, and no others.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace marrow {

/// A finite number: decimal, with optional sign, point and exponent; whole numbers also as 0x1F and 0o17.
/// `010` is refused, because YAML 1.1 reads it as 8 and YAML 1.2 as 10; so are .nan, .inf and what overflows.
std::optional<double> parse_number(std::string_view);

/// A whole number without point and exponent, else as above.
std::optional<std::int64_t> parse_integer(std::string_view);
std::optional<std::uint64_t> parse_unsigned(std::string_view);

/// What would be right, for texts that people and other formats take for numbers; else empty.
std::string number_hint(std::string_view);

/// The shortest text that parse_number() reads as this number.
std::string number_text(double);
/// "[x, y, z]"
std::string numbers_text(double, double, double);

}  // namespace marrow
