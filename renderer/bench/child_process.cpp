// Other programs, run and measured as a whole.
#include "renderer/bench/child_process.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace marrow {
namespace {

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

// Owns what posix_spawn is told about the child's files.
class SilentFiles {
 public:
  SilentFiles() {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  ~SilentFiles() { posix_spawn_file_actions_destroy(&actions_); }
  SilentFiles(const SilentFiles&) = delete;
  SilentFiles& operator=(const SilentFiles&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

// The most memory that a process has held so far, in bytes; 0 when it is gone.
std::size_t peak_of(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;)
    if (std::size_t kib = 0; word == "VmHWM:" && status >> kib) return kib * 1024;
  return 0;
}

// Looks at a child's memory while it runs, and hands a request to stop on to it. What wait4() tells of memory would not
// do: a child starts as a copy of its parent, and the parent's peak stays the least that it can report.
class ChildWatch {
 public:
  ChildWatch(pid_t process, StopRequest request)
      : thread_([this, process, request](const std::stop_token& ended) {
          for (bool is_told = false; !ended.stop_requested();) {
            if (request.is_made() && !std::exchange(is_told, true)) kill(process, SIGTERM);
            peak_ = std::max(peak_.load(), peak_of(process));
            std::this_thread::sleep_for(std::chrono::milliseconds(4));
          }
        }) {}
  /// The most memory that was seen.
  std::size_t end() {
    thread_.request_stop();
    thread_.join();
    return peak_;
  }

 private:
  std::atomic<std::size_t> peak_ = 0;
  std::jthread thread_;
};

}  // namespace

std::optional<std::filesystem::path> find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const auto program = std::filesystem::path(folder) / name;
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return std::nullopt;
}

std::optional<ChildResult> run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                       StopRequest stop) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const SilentFiles files;
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), files.get(), nullptr, argv.data(), environ) != 0) return std::nullopt;
  ChildWatch watch(child, stop);
  siginfo_t end{};
  waitid(P_PID, static_cast<id_t>(child), &end, WEXITED | WNOWAIT);  // its number stays its own while it is watched
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const std::size_t peak = watch.end();
  int status = 0;
  rusage used{};
  const bool ended = wait4(child, &status, 0, &used) == child;
  if (!ended || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return ChildResult{{wall.count(), seconds(used.ru_utime) + seconds(used.ru_stime)}, peak};
}

std::filesystem::path this_program() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown);
}

}  // namespace marrow
