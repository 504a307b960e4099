// Values of the formulas of this field, found in 40 digits by other code.
#pragma once

#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/source_folder.h"

namespace marrow::test {

inline const nlohmann::json& reference_values() {
  static const auto all =
      nlohmann::json::parse(std::ifstream(source_folder() + "/tests/field/reference/nary_blend_public.json"));
  return all;
}

}  // namespace marrow::test
