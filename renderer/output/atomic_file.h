// Replaces files so that a crash or a full disk never leaves half of one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "field/base/result.h"

namespace marrow {

/// Makes `path` hold exactly `bytes`, or leaves what was there untouched.
/// The bytes go to a temporary file in the same folder, are synced and read back, and then take the name; the folder
/// is synced last. A symbolic link is followed; an existing file keeps its permissions; a device or a pipe
/// (/dev/null, /dev/stdout) is written in place. Errors carry the operation and the system's reason. Only when the last
/// step fails, the sync of the folder, are the new bytes there and an error is returned all the same.
Status write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace marrow
