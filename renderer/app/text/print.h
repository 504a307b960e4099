// Text to the standard streams. A stream that fails is no exception in the middle of the work: main() asks at the end
// whether all of standard output arrived, and what nobody can read on standard error is lost.
#pragma once

#include <string_view>

namespace marrow {

/// On standard output.
void say(std::string_view text);

/// On standard error, and at once.
void complain(std::string_view text);

}  // namespace marrow
