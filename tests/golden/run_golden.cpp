// run_golden [--update] [scene...]: checks golden scenes, or makes new references. Without names: all of them.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/golden/golden_run.h"

namespace {

namespace fs = std::filesystem;
using namespace marrow;

std::vector<std::string> all_scenes(const fs::path& golden) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(golden))
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool complain(const Diagnostics& why) {
  for (const Diagnostic& d : why) std::fputs(render(d, {}).c_str(), stderr);
  return false;
}

bool handle(const fs::path& folder, const GoldenSetup& setup, bool update) {
  const Result<Expectation> expectation = read_expectation(folder);
  if (!expectation) return complain(expectation.why());
  if (update) {
    const Status done = update_golden(*expectation, setup);
    if (!done) return complain(done.why());
    std::printf("%s: new reference; say in the commit why\n", expectation->name.c_str());
    return true;
  }
  const Result<std::string> text = check_golden(*expectation, setup);
  if (!text) return complain(text.why());
  std::fputs(text->c_str(), stdout);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  setenv("SOURCE_DATE_EPOCH", "0", 1);  // so that a reference changes only when its pixels do
  const fs::path repository = MARROW_SOURCE_DIR, golden = repository / "golden";
  const GoldenSetup setup{.program = MARROW_PROGRAM, .repository = repository, .work = MARROW_GOLDEN_WORK};

  std::vector<std::string> names(argv + 1, argv + argc);
  const bool update = std::erase(names, "--update") > 0;
  if (names.empty()) names = all_scenes(golden);
  if (names.empty()) {
    std::fprintf(stderr, "no golden scenes in %s\n", golden.c_str());
    return 1;
  }
  bool passed = true;
  for (const std::string& name : names) passed = handle(golden / name, setup, update) && passed;
  return passed ? 0 : 1;
}
