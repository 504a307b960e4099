// Other programs, run and measured as a whole.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/bench/cost.h"
#include "renderer/bench/stop_request.h"

namespace marrow {

struct ChildResult {
  Cost cost;  ///< of the whole process and its children
  std::size_t peak_bytes = 0;
};

/// The program found on $PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Runs the program with its output thrown away, and waits; asks it to end (SIGTERM) when a stop is asked for. Nothing
/// when it cannot be started or does not end with 0.
std::optional<ChildResult> run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                       StopRequest stop = {});

/// The program that is running.
std::filesystem::path this_program();

}  // namespace marrow
