// A line at a time; all the bad ones are told.
#include "renderer/app/point_list.h"

#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include "renderer/app/text.h"

namespace marrow {
namespace {

constexpr std::string_view blanks = " \t\r";

struct Word {
  std::string_view text;
  int column = 1;
};

std::vector<Word> words_of(std::string_view line) {
  std::vector<Word> words;
  for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line.find_first_not_of(blanks, end);
  }
  return words;
}

Diagnostic problem(const SourceLocation& where, std::string message, std::size_t length) {
  return {.where = where,
          .message = std::move(message),
          .hint = "a point is x y z, with blanks between",
          .length = static_cast<int>(length)};
}

// Nothing and no problem: a line to skip.
struct LineResult {
  std::optional<Vec3d> point;
  std::optional<Diagnostic> problem;
};

LineResult read_line(std::string_view line, const std::string& name, int number) {
  const auto words = words_of(line);
  if (words.empty() || words[0].text[0] == '#') return {};
  Vec3d point;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, words.size()); ++i) {
    const auto value = parse_decimal(words[i].text);
    if (!value) {
      const SourceLocation where{name, number, words[i].column};
      return {{}, problem(where, fmt::format("`{}` is not a finite number", words[i].text), words[i].text.size())};
    }
    point[i] = *value;
  }
  if (words.size() == 3) return {point, {}};
  return {{}, problem({name, number, words[0].column}, fmt::format("found {} numbers", words.size()), 1)};
}

}  // namespace

Result<std::vector<Vec3d>> read_points(std::istream& in, const std::string& name, SourceCache& sources) {
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // a mark that some editors put before UTF-8
  std::vector<Vec3d> points;
  Diagnostics problems;
  int number = 0;
  for (const auto line : split(text, '\n')) {
    auto [point, wrong] = read_line(line, name, ++number);
    if (point) points.push_back(*point);
    if (wrong) problems.push_back(std::move(*wrong));
  }
  if (problems.empty()) return points;
  sources.add(name, std::move(text));
  return problems;
}

}  // namespace marrow
