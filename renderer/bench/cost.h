// What a piece of work costs, and ratios of such costs.
#pragma once

#include <optional>
#include <vector>

namespace marrow {

struct Cost {
  double wall_s = 0;
  double cpu_s = 0;  ///< user and system time of all threads
};

/// Of this process so far; differences are what counts.
Cost cost_so_far();

template <class Work>
Cost cost_of(const Work& work) {
  const Cost before = cost_so_far();
  work();
  const Cost after = cost_so_far();
  return {after.wall_s - before.wall_s, after.cpu_s - before.cpu_s};
}

/// Of each part by itself; nothing costs nothing.
Cost median(const std::vector<Cost>&);
double median(std::vector<double>);

/// Shorter times say little: to wake threads, to fault pages in and to share a core with others takes parts of a
/// millisecond, which would be a tenth of it and more.
inline constexpr double shortest_s = 0.005;

/// A work's costs, one a round, and whether its times are long enough to mean something.
struct Costs {
  std::vector<Cost> rounds;
  bool wall_tells = false, cpu_tells = false;
};

/// They tell when the median is not below shortest_s.
Costs whole_costs(std::vector<Cost>);

/// More of the same work: what `longer` costs over `shorter`, round by round.
struct TwoRuns {
  Cost shorter, longer;
};
/// Over `parts`, of one part. The difference of two times has the noise of both, some percent of the longer, however
/// small it is itself. So it tells when the median of the longer is not below shortest_s, and that of the difference is
/// above a fifth of it.
Costs further_costs(const std::vector<TwoRuns>&, double parts);

/// A cost of which a part may be too short to tell.
struct MaybeCost {
  std::optional<double> wall_s, cpu_s;
};
MaybeCost median(const Costs&);

/// One work over another, measured in turns. The ratios are medians of those of the rounds, so that a machine that
/// slows down for a while slows both. Nothing where one of the works is too short to tell.
struct Ratio {
  std::optional<double> wall, cpu;
};
Ratio median_ratio(const Costs& ours, const Costs& theirs);
Ratio operator*(const Ratio&, double);

}  // namespace marrow
