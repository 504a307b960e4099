// The scene format as data: printed for editors (JSON Schema) and for readers (Markdown).
#pragma once

#include <string>

namespace marrow {

/// A draft-07 JSON Schema of scene files, made from the tables that read_scene() reads with.
std::string json_schema();

/// The same tables as Markdown: one section for each map of the format.
std::string schema_markdown();

}  // namespace marrow
