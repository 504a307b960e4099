// Rows of a table in text: separators, quotes, a header or none.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "renderer/scene/files/text_scan.h"

namespace marrow {

/// A field of a row without its quotes and the blanks around it. A doubled quote inside quotes stays doubled.
struct TableField {
  std::string_view text;
  const char* place;  ///< of its first character, quotes included
};

/// The rows of a table whose fields are separated by tabs, semicolons, commas or blanks: by the first of these that the
/// first row has. Empty rows and rows that begin with # are left out.
class TableRows {
 public:
  TableRows(std::string_view text, FileProblems&);

  /// Fills `row` and returns true, or false at the end of the text. A quote without end is reported.
  bool next(std::vector<TableField>& row);
  /// An upper bound of how many there are.
  std::size_t count() const { return lines_.count(); }
  /// A number; where the comma does not separate fields it may be the decimal point.
  std::optional<double> number(std::string_view) const;

 private:
  void split(std::string_view line, std::vector<TableField>& row);

  Lines lines_;
  FileProblems& problems_;
  char separator_ = '\0';  ///< not known yet
};

}  // namespace marrow
