#include "renderer/app/machine/tracing_setup.h"

#include <algorithm>

#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include "field/base/result.h"
#include "field/math/instruction_sets.h"

namespace marrow {

std::size_t most_threads(int asked) {
  using tbb::global_control;
  return asked > 0 ? static_cast<std::size_t>(asked)
                   : global_control::active_value(global_control::max_allowed_parallelism);
}

Diagnostics missing_instruction_set(std::initializer_list<std::string_view> asked) {
  const auto sets = instruction_sets();
  for (const std::string_view name : asked)
    if (!name.empty() && std::ranges::find(sets, name) == sets.end())
      return {failure(fmt::format("--isa: this machine does not have {}, but {}", name, fmt::join(sets, " and ")))};
  return {};
}

ExitCode exit_code_of_failed_build(const Diagnostics& why) {
  const bool in_scene = std::ranges::any_of(why, [](const auto& d) { return !d.where.file.empty(); });
  return in_scene ? ExitCode::BadInput : ExitCode::Unavailable;
}

}  // namespace marrow
