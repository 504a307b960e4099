// On which side of a surface a place is.
#pragma once

namespace marrow {

enum class Side { Unknown, Outside, Inside };

}  // namespace marrow
