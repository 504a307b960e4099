// Tells the person at the terminal, or their editor, what is wrong.
#pragma once

#include <string>

#include "field/base/diagnostics.h"
#include "renderer/app/command_line/exit_code.h"
#include "renderer/scene/source_cache.h"

namespace marrow {

/// On standard error, each with its line and caret where the cache knows the text. Returns `code`, so that a command
/// can end with it.
ExitCode report(const Diagnostics&, const SourceCache&, ExitCode code);
ExitCode report(const Diagnostics&, ExitCode code);

/// For editors: a JSON array of {file, line, column, length, severity, message, hint}.
std::string to_json(const Diagnostics&);

}  // namespace marrow
