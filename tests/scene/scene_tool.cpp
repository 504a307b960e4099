// For tests outside C++: prints the schema, and says which files are scenes. For developers: refreshes the reference.
//   scene_tool schema | markdown        print
//   scene_tool refresh FILE             writes the reference anew between the two marks of docs/scene-format.md
//   scene_tool check                    for each file name on standard input: "ok" or "bad", a line each
//   scene_tool show FILE                the diagnostics of a file as a user sees them
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "renderer/scene/read_scene.h"
#include "renderer/scene/schema.h"

namespace {

bool refresh(const std::string& file) {
  std::ostringstream whole;
  whole << std::ifstream(file).rdbuf();
  std::string text = whole.str();
  const std::string mark = "<!-- reference: begin -->\n";
  const auto begin = text.find(mark), end = text.find("<!-- reference: end -->");
  if (begin == std::string::npos || end == std::string::npos) return false;
  const auto from = begin + mark.size();
  text.replace(from, end - from, marrow::schema_markdown());
  return static_cast<bool>(std::ofstream(file) << text);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "schema") std::cout << marrow::json_schema();
  if (what == "markdown") std::cout << marrow::schema_markdown();
  if (what == "refresh") return argc > 2 && refresh(argv[2]) ? 0 : 1;
  if (what == "check")
    for (std::string file; std::getline(std::cin, file);) std::cout << (marrow::read_scene(file) ? "ok\n" : "bad\n");
  if (what == "show" && argc > 2) {
    marrow::ReadRecord record;
    const auto scene = marrow::read_scene(argv[2], {}, record);
    std::cout << render_all(scene ? record.warnings : scene.why(), record.sources);
  }
}
