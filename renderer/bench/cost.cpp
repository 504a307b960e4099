// What a piece of work costs.
#include "renderer/bench/cost.h"

#include <algorithm>
#include <chrono>
#include <cstddef>

#include <sys/resource.h>

namespace marrow {

Cost cost_so_far() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return {std::chrono::duration<double>(now).count(), seconds(used.ru_utime) + seconds(used.ru_stime)};
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Cost median(const std::vector<Cost>& costs) {
  std::vector<double> wall, cpu;
  for (const Cost& c : costs) {
    wall.push_back(c.wall_s);
    cpu.push_back(c.cpu_s);
  }
  return {median(std::move(wall)), median(std::move(cpu))};
}

Ratio median_ratio(const std::vector<Cost>& ours, const std::vector<Cost>& theirs) {
  std::vector<double> wall, cpu;
  for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i) {
    if (theirs[i].wall_s > 0) wall.push_back(ours[i].wall_s / theirs[i].wall_s);
    if (theirs[i].cpu_s > 0) cpu.push_back(ours[i].cpu_s / theirs[i].cpu_s);
  }
  return {median(std::move(wall)), median(std::move(cpu))};
}

}  // namespace marrow
