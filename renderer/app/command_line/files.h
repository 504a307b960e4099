// Whether files of the command line can be used, asked before the work begins.
#pragma once

#include <filesystem>
#include <vector>

#include "field/base/result.h"

namespace marrow {

/// A file, pipe or device that exists and may be read.
Status check_readable(const std::filesystem::path&);

/// A file that may be made, or replaced, or a device that may be written. To ask, a file is made in the folder and
/// removed at once; what stands at `path` is not touched.
Status check_writable(const std::filesystem::path&);

/// A file that is none of those that were read: writing it would lose what they held.
Status check_apart(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

/// A device or a pipe, such as /dev/null: written in place, whatever its name ends with.
bool is_special(const std::filesystem::path&);

}  // namespace marrow
