// One pass over each line; fields are views into the text.
#include "renderer/scene/files/table_rows.h"

#include <algorithm>
#include <array>

#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

char separator_of(std::string_view row) {
  for (const char c : {'\t', ';', ','})
    if (row.find(c) != std::string_view::npos) return c;
  return ' ';
}

}  // namespace

TableRows::TableRows(std::string_view text, FileProblems& problems) : lines_(text), problems_(problems) {}

bool TableRows::next(std::vector<TableField>& row) {
  std::string_view line;
  while (lines_.next(line)) {
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    if (separator_ == '\0') separator_ = separator_of(content);
    row.clear();
    split(separator_ == '\t' ? line : content, row);
    return true;
  }
  return false;
}

void TableRows::split(std::string_view line, std::vector<TableField>& row) {
  const char *at = line.data(), *const end = at + line.size();
  for (;;) {
    while (at != end && is_blank(*at) && *at != separator_) ++at;
    while (separator_ == ' ' && at != end && is_blank(*at)) ++at;
    if (at != end && *at == '"') {
      const char* stop = at + 1;
      while (stop != end && (*stop != '"' || (stop + 1 != end && stop[1] == '"' && ++stop))) ++stop;
      row.push_back({std::string_view(at + 1, static_cast<std::size_t>(stop - at - 1)), at});
      if (stop == end) return problems_.complain(at, "the quote has no end", "it ends in its line, with another \"");
      at = std::find_if(stop, end, [this](char c) { return c == separator_; });
    } else {
      const char* stop =
          std::find_if(at, end, [this](char c) { return c == separator_ || (separator_ == ' ' && is_blank(c)); });
      row.push_back({trimmed({at, static_cast<std::size_t>(stop - at)}), at});
      at = stop;
    }
    if (at == end) return;
    ++at;
  }
}

std::optional<double> TableRows::number(std::string_view text) const {
  const auto plain = finite_number(text);
  if (plain || separator_ == ',') return plain;
  std::array<char, 64> copy;
  if (text.size() > copy.size() || std::count(text.begin(), text.end(), ',') != 1) return std::nullopt;
  std::replace_copy(text.begin(), text.end(), copy.begin(), ',', '.');
  return finite_number({copy.data(), text.size()});
}

}  // namespace marrow
