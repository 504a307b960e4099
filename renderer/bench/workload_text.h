// The text by which the peers of this workload know it.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/bench/workload.h"

namespace marrow {

/// The statements of read_workload(), without a name. Errors: every line that is wrong, up to 20; nothing to draw; more
/// than one `cam` or `light`.
Result<Workload> read_workload_text(std::string_view bytes, const std::string& name);

/// Places the eye so that it looks along -z at all of it, from as far as the workloads that have names: some two sides
/// of the picture away.
void look_at_all(Workload&);

/// What no scene takes: an eye, or a place straight before it, beyond 1e15 scene units.
bool eye_is_too_far(const Workload&);

}  // namespace marrow
