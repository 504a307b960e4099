// How far the share of a patch can be from a line in its part, and how it bends.
#pragma once

#include "field/trace/kernels/share_part.h"

namespace marrow {

/// Sets level, slope and `bent` of the part of a fitted patch.
void set_line(const SharePatch&, SharePart&);

/// SharePatch::bend of a fitted patch.
float bend_of(const SharePatch&);

}  // namespace marrow
