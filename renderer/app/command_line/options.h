// The command line: what may be said, and what it means.
#pragma once

#include <variant>

#include "renderer/app/command_line/commands.h"
#include "renderer/app/command_line/exit_code.h"

namespace marrow {

/// The command, or how the program ends at once: Ok after --help and --version, Usage after telling on standard error
/// what is wrong and what may have been meant.
std::variant<Command, ExitCode> parse_options(int argc, const char* const* argv);

}  // namespace marrow
