#include "tests/golden/expectation.h"

#include <fstream>

#include <nlohmann/json.hpp>

namespace marrow {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& message) { throw std::runtime_error(message); }

Thresholds parse_thresholds(const json& object) {
  Thresholds t;
  for (const auto& [key, value] : object.items()) {
    if (key == "fail") t.fail = value.get<double>();
    else if (key == "fail_percent") t.fail_percent = value.get<double>();
    else if (key == "hard_fail") t.hard_fail = value.get<double>();
    else if (key == "relative_mse") t.relative_mse = value.get<double>();
    else if (key == "relative_mean") t.relative_mean = value.get<double>();
    else refuse("unknown threshold \"" + key + "\"");
  }
  return t;
}

std::vector<std::string> parse_overrides(const json& object) {
  std::vector<std::string> overrides;
  for (const auto& [path, value] : object.items())
    overrides.push_back(path + "=" + (value.is_string() ? value.get<std::string>() : value.dump()));
  return overrides;
}

Expectation parse(const json& document) {
  Expectation e;
  for (const auto& [key, value] : document.items()) {
    if (key == "scene") e.scene = value.get<std::string>();
    else if (key == "overrides") e.overrides = parse_overrides(value);
    else if (key == "arguments") e.arguments = value.get<std::vector<std::string>>();
    else if (key == "channels") e.channels = value.get<std::vector<std::string>>();
    else if (key == "thresholds") e.thresholds = parse_thresholds(value);
    else if (key == "why") e.why = value.get<std::string>();
    else refuse("unknown key \"" + key + "\"");
  }
  if (e.scene.empty()) refuse("\"scene\" is missing");
  if (e.channels.empty()) refuse("\"channels\" is missing");
  if (e.why.empty()) refuse("\"why\" is missing: say what this picture guards");
  return e;
}

}  // namespace

Result<Expectation> read_expectation(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "expect.json";
  std::ifstream in(file);
  if (!in) return failure("cannot read", file.string());
  try {
    Expectation e = parse(json::parse(in));
    e.name = folder.filename().string();
    e.reference = folder / "reference.exr";
    return e;
  } catch (const std::exception& error) { return failure(error.what(), file.string()); }
}

}  // namespace marrow
