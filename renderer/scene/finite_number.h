// The decimal numbers of all texts that are read: command lines, scenes, data files.
#pragma once

#include <optional>
#include <string_view>

namespace marrow {

/// A finite decimal number and nothing else: no blanks, not hexadecimal, not nan or inf, nothing that overflows. A
/// leading + is allowed; the locale does not matter.
std::optional<double> finite_number(std::string_view);

}  // namespace marrow
