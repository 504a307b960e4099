// What is wrong with an input, where, and what would be right.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace marrow {

/// A place in a text file. Lines and columns count from 1; 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
  friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

enum class Severity { Error, Warning };

/// One mistake. `message` says what was found and what is wrong; `hint` says what would be right.
struct Diagnostic {
  SourceLocation where;
  std::string message;
  std::string hint;
  Severity severity = Severity::Error;
  int length = 1;  ///< characters to underline from `where.column`
};

using Diagnostics = std::vector<Diagnostic>;

/// The same, with what would be right.
inline Diagnostic with_hint(Diagnostic d, std::string hint) {
  d.hint = std::move(hint);
  return d;
}

/// `file:line:col: error: message`, the line of the file, a caret under the place, and the hint.
/// `text` is the whole text of the file; an empty text leaves line and caret out.
std::string render(const Diagnostic&, std::string_view text);

}  // namespace marrow
