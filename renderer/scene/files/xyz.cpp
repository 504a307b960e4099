// Line by line.
#include "renderer/scene/files/xyz.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "renderer/scene/files/elements.h"
#include "renderer/scene/files/molecule.h"
#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/text_scan.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

/// Columns of a line, counted from 0.
struct XyzColumns {
  std::size_t symbol = 0, position = 1;
};

std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return part;
}

// Properties=species:S:1:pos:R:3:...: names, types and counts of columns.
XyzColumns columns_of(std::string_view comment) {
  XyzColumns columns;
  constexpr std::string_view key = "Properties=";
  const std::size_t start = comment.find(key);
  if (start == std::string_view::npos) return columns;
  std::string_view list = comment.substr(start + key.size());
  if (list.starts_with('"')) list.remove_prefix(1);
  list = list.substr(0, list.find_first_of(" \t\""));
  for (std::size_t column = 0; !list.empty() && column < 1000;) {
    const std::string_view name = take_until(list, ':'), type = take_until(list, ':'), count = take_until(list, ':');
    if (name == "species" && type == "S") columns.symbol = column;
    if (name == "pos") columns.position = column;
    column += static_cast<std::size_t>(std::clamp(finite_number(count).value_or(1), 1.0, 1000.0));
  }
  return columns;
}

class XyzReader {
 public:
  XyzReader(std::string_view text, const SkeletonOptions& options, const std::string& name)
      : lines_(text), options_(options), problems_(text, name) {}

  Result<SkeletonFile> read() {
    const std::size_t count = read_count();
    std::string_view line;
    if (problems_.none() && lines_.next(line)) columns_ = columns_of(line);
    if (problems_.none()) molecule_.atoms.reserve(std::min(count, lines_.count()));
    std::size_t read = 0;
    for (; read < count && !problems_.is_full() && lines_.next(line); ++read) read_atom(line);
    if (!problems_.is_full() && read < count)
      problems_.complain_of_file(fmt::format("the first line says {} atoms, but the file has {}", count, read),
                                 "it was cut");
    if (problems_.none()) check_what_follows(count);
    SkeletonFile made;
    if (problems_.none()) made = skeleton_of(std::move(molecule_), options_, problems_);
    if (!problems_.none()) return problems_.take();
    return made;
  }

 private:
  std::size_t read_count() {
    std::string_view line;
    if (!lines_.next(line)) return problems_.complain_of_file("the file is empty"), 0;
    const std::string_view word = trimmed(line);
    const auto number = finite_number(word);
    const auto count = number ? whole_number(*number) : std::nullopt;
    if (count && *count > 0 && *count <= static_cast<long long>(NodeList::max_nodes))
      return static_cast<std::size_t>(*count);
    problems_.complain(line.data(), quoted_word(word) + " is not a number of atoms",
                       "the first line of an XYZ file is the count of its atoms");
    return 0;
  }

  // The end, or another frame, which begins with its own count.
  void check_what_follows(std::size_t count) {
    std::string_view line, word;
    while (word.empty() && lines_.next(line)) word = trimmed(line);
    if (word.empty()) return;
    const auto number = finite_number(word);
    if (number && whole_number(*number)) return;
    problems_.complain(word.data(), quoted_word(word) + " follows the last atom",
                       fmt::format("the first line says that there are {}", count));
  }

  void read_atom(std::string_view line) {
    Atom atom{};
    double* const coordinates[] = {&atom.at.x, &atom.at.y, &atom.at.z};
    const std::size_t needed = std::max(columns_.symbol + 1, columns_.position + 3);
    for (std::size_t column = 0; column < needed; ++column) {
      const std::string_view word = next_word(line);
      if (word.empty())
        return problems_.complain(word, fmt::format("the line ends after {} columns, it needs {}", column, needed),
                                  "a line is: symbol x y z");
      if (column == columns_.symbol) read_element(word, atom);
      if (column < columns_.position || column >= columns_.position + 3) continue;
      const auto number = finite_number(word);
      if (!number) problems_.complain(word, quoted_word(word) + " is not a finite number");
      else refuse_beyond(*number * options_.scale, word.data(), problems_);
      *coordinates[column - columns_.position] = number.value_or(0);
    }
    molecule_.atoms.push_back(atom);
  }

  void read_element(std::string_view word, Atom& atom) {
    auto element = find_element(word);
    const auto number = element ? std::nullopt : finite_number(word);
    if (number && *number >= 1 && *number <= element_count && whole_number(*number))
      element = static_cast<std::uint8_t>(*number - 1);
    if (element) atom.element = *element;
    else problems_.complain(word, quoted_word(word) + " is no chemical element", "a line is: symbol x y z");
  }

  Lines lines_;
  const SkeletonOptions& options_;
  FileProblems problems_;
  XyzColumns columns_;
  Molecule molecule_;
};

}  // namespace

Result<SkeletonFile> read_xyz(std::string_view text, const SkeletonOptions& options, const std::string& name) {
  return XyzReader(text, options, name).read();
}

}  // namespace marrow
