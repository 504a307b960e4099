// Whether bytes are a text.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace marrow {

struct BadByte {
  std::size_t offset;
  int line, column;  ///< from 1, the column in bytes
};

/// The first byte that is not part of a UTF-8 text: a broken, overlong or surrogate sequence (RFC 3629), or a
/// control character other than tab, line feed and carriage return.
std::optional<BadByte> first_invalid_utf8(std::string_view);

}  // namespace marrow
