// marrow schema: the scene format, for editors and for readers.
#include "renderer/app/command_line/commands.h"
#include "renderer/app/text/print.h"
#include "renderer/scene/schema.h"

namespace marrow {

ExitCode run(const SchemaCommand& command) {
  say((command.markdown ? schema_markdown() : json_schema()) + '\n');
  return ExitCode::Ok;
}

}  // namespace marrow
