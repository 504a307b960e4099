// Renders a golden scene and holds it against its reference.
#pragma once

#include <filesystem>
#include <string>

#include "field/base/result.h"
#include "tests/golden/expectation.h"

namespace marrow {

struct GoldenSetup {
  std::filesystem::path program;     ///< marrow
  std::filesystem::path repository;  ///< what Expectation::scene is relative to
  std::filesystem::path work;        ///< got.exr and, after a failure, want.exr, difference.exr and report.txt of each
                                     ///< scene go to a folder of its name in here
};

/// Renders and compares. Gives the report; a picture beyond the thresholds is an error that holds it.
Result<std::string> check_golden(const Expectation&, const GoldenSetup&);

/// Renders and makes the compared channels the new reference.
Status update_golden(const Expectation&, const GoldenSetup&);

}  // namespace marrow
