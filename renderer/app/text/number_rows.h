// Lists of numbers as text, a row a line: what lists of points and of rays have in common.
#pragma once

#include <functional>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/source_cache.h"

namespace marrow {

struct Word {
  std::string_view text;
  int column = 1;
};

/// What is wrong with a row, and the word to point at.
struct RowProblem {
  std::string message;
  Word at;
};

/// Finite numbers, as many as there is room for in `numbers` or as there are words. Problem: the first word that is
/// none.
std::optional<RowProblem> read_numbers(std::span<const Word>, std::span<double> numbers);

/// Hands each line to `take`, as words between blanks or tabs, at least one. Empty lines and lines that begin with #
/// are skipped, as is a mark before UTF-8. Errors: the problems of all lines, placed in `name`, each with `hint`;
/// `sources` then holds the text to show them with.
Status read_rows(std::istream&, const std::string& name, SourceCache& sources, const std::string& hint,
                 const std::function<std::optional<RowProblem>(std::span<const Word>)>& take);

}  // namespace marrow
