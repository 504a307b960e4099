// What a piece of work costs, and ratios of such costs.
#pragma once

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

/// One work over another, measured in turns. The ratios are medians of those of the rounds, so that a machine that
/// slows down for a while slows both.
struct Ratio {
  double wall = 0, cpu = 0;
};
Ratio median_ratio(const std::vector<Cost>& ours, const std::vector<Cost>& theirs);

}  // namespace marrow
