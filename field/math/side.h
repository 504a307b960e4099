// On which side of a surface a place is.
#pragma once

namespace marrow {

enum class Side { Unknown, Outside, Inside };

inline Side opposite(Side side) {
  if (side == Side::Unknown) return side;
  return side == Side::Inside ? Side::Outside : Side::Inside;
}

}  // namespace marrow
