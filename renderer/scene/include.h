// `include:` — the materials and subtrees of other files become the scene's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "renderer/scene/document.h"
#include "renderer/scene/reader.h"

namespace marrow {

/// What all texts of a scene together may take.
struct TextBudget {
  std::uint64_t bytes = std::uint64_t{256} << 20;
  std::size_t files = 1000;
  std::size_t values = 30'000'000;  ///< some 100 bytes each
};

/// Reads and parses one text. Nothing after reporting why; `at` is where the file is named.
std::optional<Value> read_text(const std::filesystem::path&, const Place& at, Reader&, TextBudget&,
                               std::filesystem::path& canonical);

/// Merges what `scene` includes, at most 16 files deep, each file once. Reports circles, names that are given twice,
/// and keys that an included file may not have. `canonical` is the scene's own file.
void merge_includes(Value& scene, const std::filesystem::path& canonical, Reader&, TextBudget&);

}  // namespace marrow
