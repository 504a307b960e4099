// What the commands that trace rays ask of the machine before they build surfaces.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "field/base/diagnostics.h"
#include "renderer/app/command_line/exit_code.h"

namespace marrow {

/// For tbb::global_control. 0 asked: as many as the process may use.
std::size_t most_threads(int asked);

/// A problem for the first name that this machine does not have; empty names are none. What the machine does not have
/// is no mistake of the scene.
Diagnostics missing_instruction_set(std::initializer_list<std::string_view> asked);

/// A problem with a place is the scene's; one without is the machine's.
ExitCode exit_code_of_failed_build(const Diagnostics&);

}  // namespace marrow
