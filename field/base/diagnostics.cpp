#include "field/base/diagnostics.h"

#include <algorithm>

namespace marrow {
namespace {

std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

// The caret stands under the column as an editor shows it: a tab is kept as a tab, and the
// continuation bytes of UTF-8 take no room.
std::string indent_to(std::string_view line, int column) {
  std::string indent;
  for (int i = 0; i < column - 1 && i < static_cast<int>(line.size()); ++i) {
    const unsigned char c = static_cast<unsigned char>(line[static_cast<std::size_t>(i)]);
    if (c == '\t') indent += '\t';
    else if ((c & 0xC0) != 0x80) indent += ' ';
  }
  return indent;
}

// Behind the caret, a character each; what goes on in further lines is underlined to the end of the first.
std::string rest_of_underline(std::string_view line, const Diagnostic& d) {
  const auto start = static_cast<std::size_t>(std::max(0, d.where.column - 1));
  const std::string_view marked =
      start < line.size() ? line.substr(start, static_cast<std::size_t>(std::max(1, d.length))) : "";
  const auto characters = std::count_if(marked.begin(), marked.end(),
                                        [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return std::string(static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, characters) - 1), '~');
}

std::string place(const SourceLocation& where) {
  std::string text = where.file;
  if (where.line > 0) text += ':' + std::to_string(where.line);
  if (where.line > 0 && where.column > 0) text += ':' + std::to_string(where.column);
  return text.empty() ? text : text + ": ";
}

}  // namespace

std::string render(const Diagnostic& d, std::string_view text) {
  std::string out = place(d.where);
  out += (d.severity == Severity::Error ? "error: " : "warning: ") + d.message + '\n';
  const std::string_view line = d.where.line > 0 ? line_of(text, d.where.line) : std::string_view{};
  if (!line.empty() && line.size() < 400) {
    const std::string number = std::to_string(d.where.line);
    const std::string gutter(std::max<std::size_t>(5, number.size() + 1), ' ');
    out += std::string(gutter.size() - number.size(), ' ') + number + " | " + std::string(line) + '\n';
    out += gutter + " | " + indent_to(line, d.where.column) + '^' + rest_of_underline(line, d) + '\n';
  }
  if (!d.hint.empty()) out += "      = " + d.hint + '\n';
  return out;
}

}  // namespace marrow
