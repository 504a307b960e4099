// All reading of files: each once, whole, through one descriptor, regular files only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "renderer/scene/scene_hash.h"

namespace marrow {

struct InputFile {
  std::string bytes;
  std::filesystem::path canonical;  ///< without links, of the file that was really opened
};

class InputFiles {
 public:
  static constexpr std::uint64_t max_bytes = std::uint64_t{4} << 30;  ///< of one file

  /// Before this, reading is not confined; after it only files under `folder` are read.
  void confine_to(const std::filesystem::path& folder);

  /// The whole file, which is added to the hash. Errors (without a place): missing, not regular, of /proc, /sys or
  /// /dev, outside the folder, larger than `limit`, unreadable.
  Result<InputFile> read(const std::filesystem::path&, std::uint64_t limit = max_bytes);

  void add_to_hash(std::string_view bytes) { hash_.add(bytes); }
  std::string hash() const { return hash_.hex(); }
  /// As they were named, in the order of reading.
  const std::vector<std::filesystem::path>& names() const { return names_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> names_;
  SceneHash hash_;
};

}  // namespace marrow
