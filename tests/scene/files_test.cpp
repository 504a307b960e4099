// Files that are no files, or not ours to read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "renderer/scene/input_files.h"
#include "tests/scene/scene_text.h"

namespace marrow {
namespace {

using testing::HasSubstr;

class Files : public SceneText {
 protected:
  std::string objection(const std::filesystem::path& path, std::uint64_t limit = InputFiles::max_bytes) {
    InputFiles files;
    const auto file = files.read(path, limit);
    return file ? "read" : file.why()[0].message;
  }
};

TEST_F(Files, OnlyRegularOnesAreRead) {
  ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
  std::filesystem::create_symlink("loop", folder / "loop");
  std::filesystem::create_symlink("/proc/self/environ", folder / "innocent.yaml");
  EXPECT_EQ(objection(write("good", "text")), "read");
  EXPECT_THAT(objection(folder), HasSubstr("is a folder"));
  EXPECT_THAT(objection(folder / "fifo"), HasSubstr("not a regular file"));
  EXPECT_THAT(objection("/dev/zero"), HasSubstr("not a regular file"));
  EXPECT_THAT(objection(folder / "loop"), HasSubstr("cannot read"));
  EXPECT_THAT(objection("/proc/self/mem"), HasSubstr("belongs to the system"));
  EXPECT_THAT(objection(folder / "innocent.yaml"), HasSubstr("belongs to the system"));
  EXPECT_THAT(objection(folder / "missing"), HasSubstr("No such file"));
}

TEST_F(Files, LargeOnesAreRefusedUnread) {
  const auto path = write("sparse", "");
  std::filesystem::resize_file(path, InputFiles::max_bytes + 1);
  EXPECT_THAT(objection(path), HasSubstr("the limit is 4294967296"));
  EXPECT_THAT(objection(write("small", "12345"), 4), HasSubstr("the limit is 4"));
  std::filesystem::resize_file(write("scene2.yaml", ""), (std::uint64_t{256} << 20) + 1);
  EXPECT_FALSE(read_scene(folder / "scene2.yaml"));
}

TEST_F(Files, AConfinedSceneStaysInItsFolder) {
  std::filesystem::create_directories(folder / "inner");
  write("outside.swc", "1 1 0 0 0 1 -1\n");
  write("inner/inside.swc", "1 1 0 0 0 1 -1\n");
  std::filesystem::create_symlink("../outside.swc", folder / "inner/link.swc");
  const auto loads = [&](const std::string& name, bool allow_outside) {
    const auto path = write("inner/s.yaml", "marrow: 1\nobjects: [{field: {skeleton: {file: " + name + "}}}]\n");
    return static_cast<bool>(read_scene(path, {.overrides = {}, .allow_outside = allow_outside}));
  };
  for (const std::string& name :
       {std::string("../outside.swc"), std::string("link.swc"), (folder / "outside.swc").string()}) {
    EXPECT_TRUE(loads(name, true)) << name;
    EXPECT_FALSE(loads(name, false)) << name;
  }
  EXPECT_TRUE(loads("inside.swc", false));
  EXPECT_TRUE(loads("../inner/inside.swc", false));
}

TEST_F(Files, AMissingSceneIsNamed) {
  const auto scene = read_scene(folder / "absent.yaml");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.why()[0].message, HasSubstr("absent.yaml"));
  EXPECT_FALSE(read_scene(folder));
}

}  // namespace
}  // namespace marrow
