#include "field/trace/curve/curve_entries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace marrow {
namespace {

constexpr int probes_per_step = 3;

// Else there would be more than twice as many entries.
constexpr double fewest_steps_to_kink = 2;

// The error of C on the straight lines between entries that is not worth more of them.
constexpr double allowed_error = 5e-7;

struct Steps {
  double length;
  int entry_count;
};

// As long as `entry_count` says, or a little shorter, so that the last one may reach beyond the end and an entry stands
// where the curve has its kink, at the border of the cavity branch.
Steps steps_over(double begin, double end, int entry_count, std::optional<double> kink) {
  const Steps even{(end - begin) / (entry_count - 1), entry_count};
  const double before = kink ? std::ceil((*kink - begin) / even.length) : 0;
  if (!(before >= fewest_steps_to_kink)) return even;
  const double length = (*kink - begin) / before;
  return {length, 1 + static_cast<int>(std::ceil((end - begin) / length))};
}

// Returns dC/dv at each entry.
std::vector<double> find_values(const TurnedCurve& curve, CurveEntries& e) {
  std::vector<TurnedCurve::Place> places;
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    const double u = curve.begin() + static_cast<double>(i) * e.step;
    const bool guessed = i > 1 && std::isfinite(places[i - 1].slope) && std::isfinite(places[i - 2].slope);
    places.push_back(curve.place(u, guessed ? value_behind(places[i - 2], places[i - 1], e.step) : curve.value(u)));
    e.value[i] = places[i].v;
  }
  std::vector<double> growth;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t next = std::min<std::size_t>(i + 1, places.size() - 1);
    const bool told = std::isfinite(places[i].slope);
    e.slope.push_back(told ? places[i].slope : (e.value[next] - e.value[next - 1]) / e.step);
    growth.push_back(places[i].growth);
  }
  return growth;
}

// Between entries the straight line is off by at most twice what three probes find: the error of linear
// interpolation is a smooth arch over a step, and where the curve has a kink the probes stand within a
// quarter of a step of it.
void find_errors(const TurnedCurve& curve, const std::vector<double>& growth, CurveEntries& e) {
  constexpr double least_field = 0.3;  // nearer to x = 0 than this no field has the large y of the curve
  e.below.assign(e.value.size(), 0);
  e.above.assign(e.value.size(), 0);
  for (std::size_t i = 0; i + 1 < e.value.size(); ++i) {
    double low = 0, high = 0;
    for (int k = 1; k <= probes_per_step; ++k) {
      const double fraction = static_cast<double>(k) / (probes_per_step + 1);
      const double line = e.value[i] + (e.value[i + 1] - e.value[i]) * fraction;
      const double u = curve.begin() + (static_cast<double>(i) + fraction) * e.step;
      const double error = -curve.height(u, line, {growth[i], growth[i + 1]});
      low = std::min(low, 2 * error);
      high = std::max(high, 2 * error);
    }
    for (const std::size_t j : {i, i + 1}) {
      e.below[j] = std::min(e.below[j], low);
      e.above[j] = std::max(e.above[j], high);
    }
    const double x = curve.line_of(curve.begin() + static_cast<double>(i) * e.step).x(e.value[i]);
    e.rough_steps += x > least_field && 0.5 * std::max(high, -low) * growth[i] > allowed_error;
  }
}

}  // namespace

CurveEntries curve_entries(const TurnedCurve& curve, int entry_count, std::optional<double> kink) {
  const Steps steps = steps_over(curve.begin(), curve.end(), entry_count, kink);
  CurveEntries e{.step = steps.length};
  e.value.resize(static_cast<std::size_t>(steps.entry_count));
  find_errors(curve, find_values(curve, e), e);
  return e;
}

}  // namespace marrow
