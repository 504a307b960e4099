// Laws of files that are replaced whole or not at all.
#include "renderer/output/atomic_file.h"

#include <csignal>
#include <random>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/output/temporary_folder.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

Status write(const fs::path& path, const std::string& text) {
  return write_file_atomically(path, std::as_bytes(std::span(text)));
}

// Files of this process may not grow beyond `bytes` while this lives: the kernel's own full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST(AtomicFile, HoldsExactlyTheBytes) {
  const TemporaryFolder folder;
  for (const std::string& text : {std::string("longer than the next"), std::string("short"), std::string()}) {
    ASSERT_TRUE(write(folder / "a", text));
    EXPECT_EQ(read_text(folder / "a"), text);
  }
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, FullDiskAtAnyByteLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const std::string old = "the old picture", fresh(300, 'x');
  ASSERT_TRUE(write(folder / "a", old));
  for (std::size_t limit = 0; limit < fresh.size(); ++limit) {
    const Status status = [&] {
      const FileSizeLimit full(limit);
      return write(folder / "a", fresh);
    }();
    ASSERT_FALSE(status) << "limit " << limit;
    EXPECT_THAT(status.why().front().message, HasSubstr("File too large"));
    ASSERT_EQ(read_text(folder / "a"), old) << "limit " << limit;
    ASSERT_EQ(folder.entries(), 1) << "limit " << limit;
  }
  const FileSizeLimit enough(fresh.size());
  EXPECT_TRUE(write(folder / "a", fresh));
}

// Each generation is one letter, written by a process that is killed at a random moment.
TEST(AtomicFile, KilledAtAnyMomentLeavesAWholeGeneration) {
  const TemporaryFolder folder;
  constexpr unsigned seed = 5;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  constexpr std::size_t size = 200000;
  ASSERT_TRUE(write(folder / "a", std::string(size, 'a')));
  for (int round = 0; round < 60; ++round) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0)
      for (char letter = 'a';; letter = letter == 'z' ? 'a' : static_cast<char>(letter + 1))
        if (!write(folder / "a", std::string(size, letter))) _exit(1);
    usleep(static_cast<useconds_t>(random() % 20000));
    ASSERT_EQ(kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer failed by itself";
    const std::string found = read_text(folder / "a");
    ASSERT_EQ(found, std::string(size, found.empty() ? '?' : found[0])) << "round " << round;
  }
}

TEST(AtomicFile, FullDeviceIsAnError) {
  const Status status = write("/dev/full", "x");
  ASSERT_FALSE(status);
  EXPECT_THAT(status.why().front().message, HasSubstr("No space left on device"));
}

TEST(AtomicFile, DevicesAreWrittenNotReplaced) {
  EXPECT_TRUE(write("/dev/null", "x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, KeepsPermissionsAndLinks) {
  const TemporaryFolder folder;
  write_text(folder / "real", "old");
  chmod((folder / "real").c_str(), 0640);
  fs::create_symlink("real", folder / "link");
  ASSERT_TRUE(write(folder / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "real"), "new");
  EXPECT_EQ(fs::status(folder / "real").permissions(), fs::perms(0640));
}

TEST(AtomicFile, MakesWhatALinkLeadsTo) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "inner");
  fs::create_symlink("inner/new", folder / "link");
  fs::create_symlink("link", folder / "link to the link");
  ASSERT_TRUE(write(folder / "link to the link", "x"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "inner/new"), "x");

  fs::create_symlink("missing/new", folder / "to nowhere");
  EXPECT_FALSE(write(folder / "to nowhere", "x"));
  EXPECT_TRUE(fs::is_symlink(folder / "to nowhere"));
}

TEST(AtomicFile, TakesTheLongestNameOfTheFileSystem) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  EXPECT_TRUE(write(folder / name, "x"));
  EXPECT_EQ(read_text(folder / name), "x");
}

TEST(AtomicFile, SaysWhichFileAndWhy) {
  const TemporaryFolder folder;
  const Status missing = write(folder / "no/such/a", "x");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.why().front().message, HasSubstr("No such file or directory"));
  EXPECT_THAT(missing.why().front().where.file, HasSubstr("no/such"));
  EXPECT_FALSE(write(folder.path(), "x"));
  EXPECT_FALSE(write("", "x"));
}

}  // namespace
}  // namespace marrow
