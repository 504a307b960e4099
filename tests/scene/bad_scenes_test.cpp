// Every file of scenes/bad fails with the text that stands beside it.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/scene/read_scene.h"
#include "tests/source_folder.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<fs::path> bad_scenes() {
  fs::current_path(test::source_folder());  // so that messages name files as the expectations do
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator("scenes/bad"))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class BadScene : public testing::TestWithParam<fs::path> {};

TEST_P(BadScene, FailsWithItsMessages) {
  ReadRecord record;
  const auto scene = read_scene(GetParam(), {}, record);
  ASSERT_FALSE(scene);
  EXPECT_EQ(render_all(scene.why(), record.sources), content(fs::path(GetParam()).replace_extension(".expected")));
}

INSTANTIATE_TEST_SUITE_P(Files, BadScene, testing::ValuesIn(bad_scenes()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST(BadScenes, AreMany) { EXPECT_GE(bad_scenes().size(), 15u); }

}  // namespace
}  // namespace marrow
