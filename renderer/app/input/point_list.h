// Points to evaluate a field at, from text.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "field/math/vec3.h"
#include "renderer/scene/source_cache.h"

namespace marrow {

/// One point a line: three finite numbers between blanks or tabs. Empty lines and lines that begin with # are skipped.
/// Errors: every line that is something else, placed in `name`; `sources` then holds the text to show them with.
Result<std::vector<Vec3d>> read_points(std::istream&, const std::string& name, SourceCache& sources);

}  // namespace marrow
