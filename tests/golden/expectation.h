// What a golden scene promises: the content of its expect.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "tests/golden/compare.h"

namespace marrow {

struct Expectation {
  std::string name;                    ///< of the folder
  std::filesystem::path reference;     ///< golden/<name>/reference.exr
  std::string scene;                   ///< relative to the repository
  std::vector<std::string> overrides;  ///< "path=value", one -D each
  std::vector<std::string> arguments;  ///< further arguments of `marrow render`
  std::vector<std::string> channels;   ///< what is compared
  Thresholds thresholds;
  std::string why;  ///< what this picture guards, and why these thresholds
};

/// Reads <folder>/expect.json. Unknown keys, missing scene, channels or why are errors.
Result<Expectation> read_expectation(const std::filesystem::path& folder);

}  // namespace marrow
