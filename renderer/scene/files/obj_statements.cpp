#include "renderer/scene/files/obj_statements.h"

#include <fmt/core.h>

#include "renderer/scene/finite_number.h"

namespace marrow {

bool ObjLines::next(ObjLine& made) {
  std::string_view line;
  if (!lines_.next(line)) return false;
  line = line.substr(0, line.find('#'));
  const bool goes_on = line.ends_with('\\');
  if (goes_on) line.remove_suffix(1);
  const bool is_first = keyword_.empty();
  if (is_first) keyword_ = next_word(line);
  made = {keyword_, line, is_first, !goes_on};
  if (!goes_on) keyword_ = {};
  return true;
}

std::optional<std::int32_t> obj_index(std::string_view word, std::size_t count, std::size_t limit,
                                      FileProblems& problems) {
  const auto number = finite_number(word.substr(0, word.find('/')));
  const auto index = number ? whole_number(*number) : std::nullopt;
  const auto came = static_cast<long long>(count);
  if (index && *index > 0 && *index <= static_cast<long long>(limit)) return static_cast<std::int32_t>(*index - 1);
  if (index && *index < 0 && *index >= -came) return static_cast<std::int32_t>(came + *index);
  if (index && *index < 0) problems.complain(word, fmt::format("there is no vertex {}: {} came before", *index, count));
  else
    problems.complain(word, quoted_word(word) + " is not the number of a vertex",
                      "vertices are counted from 1, or from -1 backwards");
  return std::nullopt;
}

}  // namespace marrow
