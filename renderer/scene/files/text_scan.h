// What readers of text files share: lines, words, and mistakes with their places.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "field/base/diagnostics.h"

namespace marrow {

/// Collects what is wrong with one text, up to 20 mistakes. Places are pointers into the text, or null; line
/// and column are counted only for what is reported, and the word that stands there is underlined. Text and name must
/// outlive it.
class FileProblems {
 public:
  static constexpr std::size_t max_problems = 20;

  FileProblems(std::string_view text, const std::string& name);

  bool none() const { return found_.empty(); }
  /// Nothing more is worth reading.
  bool is_full() const { return found_.size() >= max_problems || is_over_; }

  void complain(const char* place, std::string message, std::string hint = {});
  /// A word of the text; an empty one where a word is missing.
  void complain(std::string_view word, std::string message, std::string hint = {});
  /// About the line from there on, which is underlined.
  void complain_of_line(const char* place, std::string message, std::string hint = {});
  /// About the whole file.
  void complain_of_file(std::string message, std::string hint = {});
  /// The last problem that is taken.
  void give_up(const char* place, std::string message, std::string hint = {});
  Diagnostic warning(std::string message, std::string hint) const;

  std::size_t line_of(const char* place) const;  ///< from 1
  /// What stands there, up to a blank, a comma or a semicolon; empty at the end of a line.
  std::string_view word_at(const char* place) const;
  /// In the order of their places, those without one first.
  Diagnostics take();

 private:
  void add(const char* place, std::size_t length, std::string message, std::string hint);

  std::string_view text_;
  const std::string& name_;
  char end_;  ///< of a line
  Diagnostics found_;
  bool is_over_ = false;
};

/// The lines of a text without their ends (LF, CR LF, or CR where there is no LF) and without a byte order mark.
class Lines {
 public:
  explicit Lines(std::string_view text);
  /// False at the end of the text.
  bool next(std::string_view& line);
  /// An upper bound of how many there are.
  std::size_t count() const;

 private:
  std::string_view rest_;
  char end_;
};

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Takes the next word off a line; empty (at the end of the line) when there is none.
std::string_view next_word(std::string_view& line);
std::string_view trimmed(std::string_view);

/// A whole number up to 2^53, which tables often write with a point.
std::optional<long long> whole_number(double);

/// `word` for a message: in back ticks, shortened, without control characters and bytes that are not ASCII.
std::string quoted_word(std::string_view);

}  // namespace marrow
