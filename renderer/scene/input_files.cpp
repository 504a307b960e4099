// POSIX descriptors, because what is checked must be what is read.
#include "renderer/scene/input_files.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <optional>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include "renderer/scene/suggestion.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  // O_NONBLOCK: a FIFO without a writer must not hold us up.
  explicit Descriptor(const fs::path& path) : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

bool is_under(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

bool is_of_the_system(const fs::path& path) {
  return is_under(path, "/proc") || is_under(path, "/sys") || is_under(path, "/dev");
}

std::string quoted(const fs::path& path) { return fmt::format("`{}`", path.string()); }

Diagnostic cannot_open(const fs::path& path, int error) {
  Diagnostic d = failure("cannot read " + quoted(path) + ": " + std::strerror(error));
  if (error != ENOENT) return d;
  std::vector<std::string> names;
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end && names.size() < 10000;
       entry.increment(ignored))
    names.push_back(entry->path().filename().string());
  std::sort(names.begin(), names.end());
  if (!fs::is_directory(folder, ignored)) d.hint = "there is no folder " + quoted(folder);
  else if (const auto close = nearest(path.filename().string(), names)) d.hint = "did you mean `" + *close + "`?";
  return d;
}

std::optional<Diagnostic> objection(const fs::path& path, const struct stat& status, std::uint64_t limit) {
  if (S_ISDIR(status.st_mode)) return failure(quoted(path) + " is a folder, not a file");
  if (!S_ISREG(status.st_mode)) return failure(quoted(path) + " is not a regular file");
  if (static_cast<std::uint64_t>(status.st_size) > limit)
    return failure(quoted(path) + " has " + std::to_string(status.st_size) + " bytes; the limit is " +
                   std::to_string(limit));
  return std::nullopt;
}

// Fills `bytes` up to the size that it has; a file that shrinks meanwhile gives less.
int read_all(int fd, std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  bytes.resize(done);
  return 0;
}

}  // namespace

void InputFiles::confine_to(const fs::path& folder) {
  std::error_code ignored;
  folder_ = fs::canonical(folder.empty() ? fs::path(".") : folder, ignored);
}

Result<InputFile> InputFiles::read(const fs::path& path, std::uint64_t limit) {
  const Descriptor file(path);
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) return cannot_open(path, errno);
  if (auto why = objection(path, status, limit)) return *std::move(why);

  InputFile input;
  std::error_code no_name;
  input.canonical = fs::read_symlink("/proc/self/fd/" + std::to_string(file.get()), no_name);
  if (no_name) return failure("cannot tell where " + quoted(path) + " lies: " + no_name.message());
  if (is_of_the_system(input.canonical)) return failure(quoted(path) + " belongs to the system");
  if (!folder_.empty() && !is_under(input.canonical, folder_))
    return failure(quoted(path) + " lies outside the scene's folder, and this scene may not leave it");
  try {
    input.bytes.resize(static_cast<std::size_t>(status.st_size));
  } catch (const std::bad_alloc&) {
    return failure("there is no memory for the " + std::to_string(status.st_size) + " bytes of " + quoted(path));
  }
  if (const int error = read_all(file.get(), input.bytes)) return cannot_open(path, error);
  hash_.add(input.bytes);
  names_.push_back(path);
  return input;
}

}  // namespace marrow
