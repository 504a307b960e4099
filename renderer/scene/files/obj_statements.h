// What readers of Wavefront OBJ share.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "renderer/scene/files/text_scan.h"

namespace marrow {

/// A statement, or a part of one that goes on from line to line.
struct ObjLine {
  std::string_view keyword;  ///< of the statement, where that stands
  std::string_view words;    ///< the rest of this line
  bool is_first, is_last;    ///< of the statement
};

/// Line by line, without comments; `\` at the end joins a line to the next.
class ObjLines {
 public:
  explicit ObjLines(std::string_view text) : lines_(text) {}
  bool next(ObjLine&);

 private:
  Lines lines_;
  std::string_view keyword_;  // of a statement that goes on, else empty
};

/// The vertex that `7`, `7/3` or `-1` names when `count` came before, from 0; up to `limit`, and those from 1 on may
/// come later. Nothing after a complaint.
std::optional<std::int32_t> obj_index(std::string_view word, std::size_t count, std::size_t limit, FileProblems&);

}  // namespace marrow
