// A line at a time; all the bad ones are told.
#include "renderer/app/text/number_rows.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include <fmt/core.h>

#include "renderer/app/text/text.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

std::vector<Word> words_of(std::string_view line) {
  constexpr std::string_view blanks = " \t\r";
  std::vector<Word> words;
  for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line.find_first_not_of(blanks, end);
  }
  return words;
}

}  // namespace

std::optional<RowProblem> read_numbers(std::span<const Word> words, std::span<double> numbers) {
  for (std::size_t i = 0; i < std::min(words.size(), numbers.size()); ++i) {
    const auto value = finite_number(words[i].text);
    if (!value) return RowProblem{fmt::format("`{}` is not a finite number", words[i].text), words[i]};
    numbers[i] = *value;
  }
  return std::nullopt;
}

Status read_rows(std::istream& in, const std::string& name, SourceCache& sources, const std::string& hint,
                 const std::function<std::optional<RowProblem>(std::span<const Word>)>& take) {
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // a mark that some editors put before UTF-8
  Diagnostics problems;
  int line = 0;
  for (const auto content : split(text, '\n')) {
    ++line;
    const auto words = words_of(content);
    if (words.empty() || words[0].text[0] == '#') continue;
    if (auto wrong = take(words))
      problems.push_back({.where = {name, line, wrong->at.column},
                          .message = std::move(wrong->message),
                          .hint = hint,
                          .length = static_cast<int>(wrong->at.text.size())});
  }
  if (problems.empty()) return Done{};
  sources.add(name, std::move(text));
  return problems;
}

}  // namespace marrow
