#include "renderer/output/atomic_file.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace marrow {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const std::byte>;

Diagnostic system_failure(const std::string& action, const fs::path& path) {
  return failure(action + ": " + std::generic_category().message(errno), path.string());
}

// close() may be the first to tell of a lost write, so the owner closes by hand and the destructor is for errors.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  File(File&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  int fd() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

constexpr std::size_t largest_write = std::size_t{1} << 30;  // Linux takes at most 2^31 - 4096 at once

// `write_some` takes bytes and how many stand before them.
template <class WriteSome>
bool write_all(Bytes bytes, const WriteSome& write_some) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write_some(bytes.subspan(done, std::min(bytes.size() - done, largest_write)), done);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = ENOSPC;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

// True when the file holds these bytes and no more; errno is EIO when it holds others.
bool holds(int fd, Bytes bytes) {
  std::array<std::byte, std::size_t{1} << 16> buffer;
  struct stat info {};
  if (::fstat(fd, &info) != 0) return false;
  bool same = static_cast<std::size_t>(info.st_size) == bytes.size();
  for (std::size_t at = 0; same && at < bytes.size();) {
    const ssize_t n = ::pread(fd, buffer.data(), buffer.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    const std::size_t count = static_cast<std::size_t>(n);
    same = count > 0 && at + count <= bytes.size() && std::memcmp(buffer.data(), bytes.data() + at, count) == 0;
    at += count;
  }
  if (!same) errno = EIO;
  return same;
}

// A name in the same folder, so that rename() stays within one file system. It does not grow with the target's name,
// which may already be as long as the file system allows.
File create_temporary(const fs::path& folder, fs::path& name) {
  static std::atomic<unsigned> counter{0};
  for (int attempt = 0; attempt < 1000; ++attempt) {
    name = folder / (".marrow-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
    File file(::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.is_open() || errno != EEXIST) return file;
  }
  return File(-1);
}

Status write_in_place(const fs::path& path, Bytes bytes) {
  File file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.is_open()) return system_failure("cannot open", path);
  if (!write_all(bytes, [&](Bytes b, std::size_t) { return ::write(file.fd(), b.data(), b.size()); }))
    return system_failure("cannot write", path);
  if (!file.close()) return system_failure("cannot close", path);
  return Done{};
}

Status sync_folder(const fs::path& folder) {
  File file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!file.is_open()) return system_failure("cannot open the folder", folder);
  // Some network file systems cannot sync a folder and say EINVAL: there the rename is all one can have.
  if (::fsync(file.fd()) != 0 && errno != EINVAL) return system_failure("cannot sync the folder", folder);
  return Done{};
}

}  // namespace

Result<fs::path> file_behind(const fs::path& path) {
  constexpr int most_links = 40;  // as many as the system follows
  fs::path file = path;
  std::error_code error;
  // Links that loop are left to fs::weakly_canonical, which has the system's reason.
  for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(file, error)); ++i)
    file = file.parent_path() / fs::read_symlink(file, error);
  file = fs::absolute(file, error);
  if (!error) file = fs::weakly_canonical(file, error);
  if (error) return failure("cannot be written: " + error.message(), path.string());
  return file;
}

struct AtomicFile::Target {
  fs::path path;       // as it was named
  fs::path real;       // where links lead
  fs::path temporary;  // empty: written in place
  File file = File(-1);
  int error = 0;  // of the first part that could not be written

  // Everything up to the rename
  Status fill_and_rename(Bytes bytes) {
    struct stat old {};
    if (::stat(real.c_str(), &old) == 0 && ::fchmod(file.fd(), old.st_mode & 07777) != 0)
      return system_failure("cannot keep the permissions of the old file", real);
    if (errno = error; error != 0) return system_failure("cannot write", real);
    if (::fsync(file.fd()) != 0) return system_failure("cannot sync", real);
    if (!holds(file.fd(), bytes)) return system_failure("the file does not read back as it was written", real);
    if (!file.close()) return system_failure("cannot close", real);
    if (::rename(temporary.c_str(), real.c_str()) != 0) return system_failure("cannot rename into place", real);
    temporary.clear();
    return Done{};
  }

  fs::path folder() const { return real.has_parent_path() ? real.parent_path() : fs::path("."); }
};

AtomicFile::AtomicFile(std::unique_ptr<Target> target) : target_(std::move(target)) {}
AtomicFile::AtomicFile(AtomicFile&&) noexcept = default;
AtomicFile::~AtomicFile() {
  if (target_ && !target_->temporary.empty()) ::unlink(target_->temporary.c_str());
}

Result<AtomicFile> AtomicFile::open(const fs::path& path) {
  if (!path.has_filename()) return failure("not the name of a file", path.string());
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return failure("cannot write: is a folder", path.string());
  auto target = std::make_unique<Target>();
  target->path = path;
  if (fs::exists(status) && !fs::is_regular_file(status)) return AtomicFile(std::move(target));

  auto real = file_behind(path);
  if (!real) return real.why();
  target->real = std::move(*real);
  fs::path temporary;
  File file = create_temporary(target->folder(), temporary);
  if (!file.is_open()) return system_failure("cannot create a file in the folder", target->folder());
  target->temporary = std::move(temporary);
  target->file = std::move(file);
  return AtomicFile(std::move(target));
}

void AtomicFile::put(std::size_t at, Bytes part) {
  Target& target = *target_;
  if (target.temporary.empty() || target.error != 0) return;
  const int fd = target.file.fd();
  const auto start = static_cast<off_t>(at);
  if (!write_all(part, [&](Bytes b, std::size_t before) {
        return ::pwrite(fd, b.data(), b.size(), start + static_cast<off_t>(before));
      }))
    target.error = errno;
  // Only a hint: the sync at the end then has less to wait for
  ::sync_file_range(fd, start, static_cast<off_t>(part.size()), SYNC_FILE_RANGE_WRITE);
}

Status AtomicFile::finish(Bytes bytes) {
  if (target_->temporary.empty()) return write_in_place(target_->path, bytes);
  if (Status written = target_->fill_and_rename(bytes); !written) return written;
  return sync_folder(target_->folder());
}

Status write_file_atomically(const fs::path& path, Bytes bytes) {
  auto file = AtomicFile::open(path);
  if (!file) return file.why();
  file->put(0, bytes);
  return file->finish(bytes);
}

}  // namespace marrow
