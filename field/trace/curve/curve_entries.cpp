#include "field/trace/curve/curve_entries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "field/blend/correction/correction.h"

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

void find_values(const TurnedCurve& curve, CurveEntries& e) {
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    // By the parabola through the last three.
    const double guess = i < 3 ? 0 : 3 * (e.value[i - 1] - e.value[i - 2]) + e.value[i - 3];
    const double known = i < 3 ? 0 : 1e-4 * e.step;
    e.value[i] = curve.value(curve.begin() + static_cast<double>(i) * e.step, guess, known);
  }
}

// dV/du from the partials: along the curve C_x dx + C_y dy = 0. Returns dC/dv at each entry.
std::vector<double> find_slopes(const TurnedCurve& curve, const Correction& correction, CurveEntries& e) {
  std::vector<double> growth(e.value.size());
  e.slope.resize(e.value.size());
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    const TurnedLine line = curve.line_of(curve.begin() + static_cast<double>(i) * e.step);
    const auto c = correction.partials(line.x(e.value[i]), line.y(e.value[i]));
    growth[i] = curve.sine() * c.df + curve.cosine() * c.dG;
    const double slope = (curve.cosine() * c.df - curve.sine() * c.dG) / growth[i];
    const std::size_t next = std::min<std::size_t>(i + 1, e.value.size() - 1);
    e.slope[i] = std::isfinite(slope) ? slope : (e.value[next] - e.value[next - 1]) / e.step;
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
  double known = 1e-6;
  for (std::size_t i = 0; i + 1 < e.value.size(); ++i) {
    double low = 0, high = 0;
    for (int k = 1; k <= probes_per_step; ++k) {
      const double fraction = static_cast<double>(k) / (probes_per_step + 1);
      const double line = e.value[i] + (e.value[i + 1] - e.value[i]) * fraction;
      const double error =
          curve.value(curve.begin() + (static_cast<double>(i) + fraction) * e.step, line, known) - line;
      low = std::min(low, 2 * error);
      high = std::max(high, 2 * error);
    }
    known = 2 * std::max(high, -low) + 1e-9;
    for (const std::size_t j : {i, i + 1}) {
      e.below[j] = std::min(e.below[j], low);
      e.above[j] = std::max(e.above[j], high);
    }
    const double x = curve.line_of(curve.begin() + static_cast<double>(i) * e.step).x(e.value[i]);
    e.rough_steps += x > least_field && 0.5 * std::max(high, -low) * growth[i] > allowed_error;
  }
}

}  // namespace

CurveEntries curve_entries(const TurnedCurve& curve, const Correction& correction, int entry_count,
                           std::optional<double> kink) {
  const Steps steps = steps_over(curve.begin(), curve.end(), entry_count, kink);
  CurveEntries e{.step = steps.length};
  e.value.resize(static_cast<std::size_t>(steps.entry_count));
  find_values(curve, e);
  find_errors(curve, find_slopes(curve, correction, e), e);
  return e;
}

}  // namespace marrow
