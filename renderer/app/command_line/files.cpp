// The questions are put to the system, so that the answers respect owners, mounts and access lists.
#include "renderer/app/command_line/files.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include <unistd.h>

#include "renderer/output/atomic_file.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;

Status ask(const fs::path& path, int mode, const std::string& what) {
  if (access(path.c_str(), mode) == 0) return Done{};
  return failure("cannot " + what + ": " + std::strerror(errno), path.string());
}

// Permissions are not all: a file system may be read-only, full, or none at all, as /proc is even to root.
Status try_to_make_a_file(const fs::path& folder, const fs::path& path) {
  std::string name = (folder / ".marrow-can-write-XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) return failure(std::string("cannot be written: ") + std::strerror(errno), path.string());
  close(file);
  unlink(name.c_str());
  return Done{};
}

}  // namespace

Status check_readable(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return failure("cannot be read: it is a folder", path.string());
  return ask(path, R_OK, "be read");
}

Status check_writable(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return failure("cannot be written: it is a folder", path.string());
  if (fs::exists(path, error)) {
    if (auto status = ask(path, W_OK, "be replaced"); !status || is_special(path)) return status;
  }
  // A symbolic link keeps its name; what it points to is replaced in the folder where that stands.
  const auto file = file_behind(path);
  if (!file) return file.why();
  const fs::path folder = file->parent_path();
  if (!fs::is_directory(folder, error)) {
    return failure("cannot be written: there is no folder " + folder.string(), path.string());
  }
  return try_to_make_a_file(folder, path);
}

Status check_apart(const fs::path& output, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code error;
    if (is_special(output) || !fs::equivalent(output, input, error) || error) continue;
    return with_hint(failure("cannot be written: the scene is made from it", output.string()), "-o gives another name");
  }
  return Done{};
}

bool is_special(const fs::path& path) {
  std::error_code error;
  const auto type = fs::status(path, error).type();
  return type == fs::file_type::character || type == fs::file_type::block || type == fs::file_type::fifo;
}

}  // namespace marrow
