// Replaces files so that a crash or a full disk never leaves half of one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "field/base/result.h"

namespace marrow {

/// The file that `path` stands for: symbolic links are followed, one that leads to nothing yet, too. Error: links that
/// lead back to themselves, names that are too long.
Result<std::filesystem::path> file_behind(const std::filesystem::path& path);

/// A file that takes its name once it is whole.
/// The bytes go to a temporary file in the same folder, are synced and read back, and then take the name; the folder
/// is synced last. A symbolic link is followed; an existing file keeps its permissions; a device or a pipe
/// (/dev/null, /dev/stdout) is written in place. Errors carry the operation and the system's reason. Only when the last
/// step fails, the sync of the folder, are the new bytes there and an error is returned all the same.
class AtomicFile {
 public:
  static Result<AtomicFile> open(const std::filesystem::path&);
  AtomicFile(AtomicFile&&) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();  ///< unless it was finished, what was there is untouched

  /// Part of what the file is to hold, which goes towards the disk meanwhile. finish() tells if it failed.
  void put(std::size_t at, std::span<const std::byte> part);

  /// All that the file is to hold, put before.
  Status finish(std::span<const std::byte> bytes);

 private:
  struct Target;
  explicit AtomicFile(std::unique_ptr<Target>);
  std::unique_ptr<Target> target_;
};

/// Makes `path` hold exactly `bytes`, or leaves what was there untouched.
Status write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace marrow
