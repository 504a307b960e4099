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

Costs whole_costs(std::vector<Cost> rounds) {
  const Cost middle = median(rounds);
  return {std::move(rounds), middle.wall_s >= shortest_s, middle.cpu_s >= shortest_s};
}

Costs further_costs(const std::vector<TwoRuns>& runs, double parts) {
  constexpr double least_share = 0.2;
  std::vector<Cost> longer, differences;
  Costs costs;
  for (const TwoRuns& r : runs) {
    const Cost more{r.longer.wall_s - r.shorter.wall_s, r.longer.cpu_s - r.shorter.cpu_s};
    longer.push_back(r.longer);
    differences.push_back(more);
    costs.rounds.push_back({more.wall_s / parts, more.cpu_s / parts});
  }
  const Cost whole = median(longer), difference = median(differences);
  const auto tells = [](double all, double more) { return all >= shortest_s && more > least_share * all; };
  costs.wall_tells = tells(whole.wall_s, difference.wall_s);
  costs.cpu_tells = tells(whole.cpu_s, difference.cpu_s);
  return costs;
}

MaybeCost median(const Costs& costs) {
  const Cost middle = median(costs.rounds);
  MaybeCost known;
  if (costs.wall_tells) known.wall_s = middle.wall_s;
  if (costs.cpu_tells) known.cpu_s = middle.cpu_s;
  return known;
}

Ratio median_ratio(const Costs& ours, const Costs& theirs) {
  std::vector<double> wall, cpu;
  for (std::size_t i = 0; i < std::min(ours.rounds.size(), theirs.rounds.size()); ++i) {
    const Cost &a = ours.rounds[i], &b = theirs.rounds[i];
    if (b.wall_s > 0) wall.push_back(a.wall_s / b.wall_s);
    if (b.cpu_s > 0) cpu.push_back(a.cpu_s / b.cpu_s);
  }
  Ratio ratio;
  if (ours.wall_tells && theirs.wall_tells && !wall.empty()) ratio.wall = median(std::move(wall));
  if (ours.cpu_tells && theirs.cpu_tells && !cpu.empty()) ratio.cpu = median(std::move(cpu));
  return ratio;
}

Ratio operator*(const Ratio& ratio, double factor) {
  Ratio scaled = ratio;
  if (scaled.wall) *scaled.wall *= factor;
  if (scaled.cpu) *scaled.cpu *= factor;
  return scaled;
}

}  // namespace marrow
