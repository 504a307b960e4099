// Scenes from texts, for tests.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "renderer/scene/read_scene.h"

namespace marrow {

/// A folder of its own for each test, removed afterwards.
class SceneText : public testing::Test {
 protected:
  SceneText() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder =
        std::filesystem::temp_directory_path() / ("marrow_scene_" + std::to_string(::getpid()) + "_" + test->name());
    std::filesystem::create_directories(folder);
  }
  ~SceneText() override { std::filesystem::remove_all(folder); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  Result<SceneDescription> read(const std::string& text, const ReadOptions& options = {}) {
    record = {};
    return read_scene(write("scene.yaml", text), options, record);
  }
  /// The one message of a scene that must fail; all of them when there are more.
  std::string error_of(const std::string& text, const ReadOptions& options = {}) {
    const auto scene = read(text, options);
    return scene ? "no error" : render_all(scene.why(), record.sources);
  }

  std::filesystem::path folder;
  ReadRecord record;
};

}  // namespace marrow
