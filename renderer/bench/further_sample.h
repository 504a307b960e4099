// What one more sample of each pixel costs, in a whole render.
#pragma once

#include <vector>

#include "renderer/bench/cost.h"
#include "renderer/bench/prepared_scene.h"
#include "renderer/bench/stop_request.h"

namespace marrow {

/// Sixteen samples and one, so that what is done once cancels. Fifteen go together, in the second pass of render(); the
/// rays of a single sample go to the pixels' middles, as sixteen have to beside their own.
TwoRuns sixteen_samples_and_one(const PreparedScene&, int threads, StopRequest);

/// Of such runs, one a round: the cost of one further sample.
inline Costs further_sample_costs(const std::vector<TwoRuns>& runs) { return further_costs(runs, 15); }

}  // namespace marrow
