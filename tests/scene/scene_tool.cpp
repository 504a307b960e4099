// For tests outside C++: prints the schema, and says which files are scenes.
//   scene_tool schema | markdown        print
//   scene_tool check                    for each file name on standard input: "ok" or "bad", a line each
//   scene_tool show FILE                the diagnostics of a file as a user sees them
#include <iostream>
#include <string>

#include "renderer/scene/read_scene.h"
#include "renderer/scene/schema.h"

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "schema") std::cout << marrow::json_schema();
  if (what == "markdown") std::cout << marrow::schema_markdown();
  if (what == "check")
    for (std::string file; std::getline(std::cin, file);) std::cout << (marrow::read_scene(file) ? "ok\n" : "bad\n");
  if (what == "show" && argc > 2) {
    marrow::ReadRecord record;
    const auto scene = marrow::read_scene(argv[2], {}, record);
    std::cout << render_all(scene ? record.warnings : scene.why(), record.sources);
  }
}
