// The grammar of RFC 3629, section 4, one row of it for each first byte.
#include "renderer/scene/utf8.h"

#include <algorithm>

namespace marrow {
namespace {

unsigned char byte(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

// Bytes of the character that starts at `i`; 0 when there is none.
std::size_t character_length(std::string_view text, std::size_t i) {
  const unsigned char first = byte(text, i);
  if (first < 0x80) return first >= 0x20 ? (first != 0x7F) : (first == '\t' || first == '\n' || first == '\r');
  if (first < 0xC2 || first > 0xF4) return 0;
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (i + length > text.size()) return 0;
  const unsigned char low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;   // no overlong forms
  const unsigned char high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;  // no surrogates, nothing past 10FFFF
  if (byte(text, i + 1) < low || byte(text, i + 1) > high) return 0;
  for (std::size_t k = 2; k < length; ++k)
    if ((byte(text, i + k) & 0xC0) != 0x80) return 0;
  return length;
}

}  // namespace

std::optional<BadByte> first_invalid_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text, i);
    if (length == 0) {
      const auto before = text.substr(0, i);
      const auto line = 1 + std::count(before.begin(), before.end(), '\n');
      const std::size_t start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
      return BadByte{.offset = i, .line = static_cast<int>(line), .column = static_cast<int>(i - start + 1)};
    }
    i += length;
  }
  return std::nullopt;
}

}  // namespace marrow
