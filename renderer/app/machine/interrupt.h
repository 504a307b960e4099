// A signal asks the program to stop; the work stops where the picture is whole.
#pragma once

#include <atomic>

namespace marrow {

/// From the first call on, SIGINT and SIGTERM set the flag instead of ending the program, once each: a second one ends
/// it at once.
const std::atomic<bool>& interruption_flag();

}  // namespace marrow
