#include "field/trace/curve/iso_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/trace/curve/curve_entries.h"

namespace marrow {
namespace {

// Of the table of one angle.
constexpr int fewest_entries = 2048, most_entries = 8192;
// Without cavity some lines stay rough, where G is nearly 0 and the slope of C not bounded.
constexpr int most_rough_steps = 12;

double on_lines(const std::vector<float>& table, double place) {
  const auto i = static_cast<std::size_t>(place);
  return table[i] + (static_cast<double>(table[i + 1]) - table[i]) * (place - static_cast<double>(i));
}

// How many times as long as usual it is, as steps are to stay as short.
int times_as_long(const TurnedCurve& curve, const Correction& correction) {
  return std::max(1, static_cast<int>(std::ceil(curve.end() / usual_gradient(correction))));
}

}  // namespace

IsoTable::IsoTable(const Correction& correction, double alpha, UpToGradient up_to)
    : IsoTable(correction, {correction, critical_field_of(correction), turn_for(alpha, alpha), up_to}, alpha,
               {fewest_entries, most_entries}) {}

IsoTable::IsoTable(const Correction& correction, double alpha, int entry_count)
    : IsoTable(correction,
               {correction, critical_field_of(correction), alpha < 0 ? turn_for(alpha, alpha) : alpha,
                UpToGradient{usual_gradient(correction)}},
               alpha, {entry_count, entry_count}) {}

IsoTable::IsoTable(const Correction& correction, const TurnedCurve& curve, double alpha, Entries entries)
    : critical_(critical_field_of(correction)), two_sided_(alpha < 0) {
  const int times = times_as_long(curve, correction);
  sin_ = curve.sine();
  cos_ = curve.cosine();
  u_begin_ = curve.begin();
  ends_at_axis_ = curve.ends_at_axis();
  const auto kink = curve.kink();
  CurveEntries e;
  for (int count = entries.fewest * times; count <= entries.most * times; count *= 2) {
    e = curve_entries(curve, count, kink);
    if (e.rough_steps <= most_rough_steps) break;
  }
  step_ = e.step;
  constexpr double rounding = 4e-7;  // of float entries and of their interpolation in float, relative
  double highest = 0;
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    const double slack = rounding * (1 + std::fabs(e.value[i]));
    value_.push_back(static_cast<float>(e.value[i]));
    lower_.push_back(static_cast<float>(e.value[i] + e.below[i] - slack));
    upper_.push_back(static_cast<float>(e.value[i] + e.above[i] + slack));
    slope_.push_back(static_cast<float>(e.slope[i]));
    const Point p = point(static_cast<int>(i));
    if (p.y > highest) peak_x_ = p.x;
    highest = std::max(highest, p.y);
  }
  // Level from there on: a slope in float would be wrong by far more than V rises where G is large.
  if (!ends_at_axis_)
    for (auto* table : {&value_, &lower_, &upper_, &slope_}) table->push_back(table->back());
}

IsoTable::View IsoTable::view() const {
  return {.value = value_.data(),
          .lower = lower_.data(),
          .slope = slope_.data(),
          .size = static_cast<int>(value_.size()),
          .u_begin = static_cast<float>(u_begin_),
          .inverse_step = static_cast<float>(1 / step_),
          .sin_theta = static_cast<float>(sin_),
          .cos_theta = static_cast<float>(cos_),
          .two_sided = two_sided_,
          .peak_x = static_cast<float>(peak_x_),
          .critical = static_cast<float>(critical_ * (1 + 1e-6)),
          .lower_beyond = static_cast<float>(beyond(lower_))};
}

// All that comes behind the axis x = 0 is inside. Elsewhere V does not fall there: for the exact projection it is level
// (C = 1 where v is that of the reference curve), for the paper's it rises up to that axis; checked numerically.
double IsoTable::beyond(const std::vector<float>& table) const {
  if (ends_at_axis_) return -std::numeric_limits<double>::infinity();
  return table.back();
}

// In steps from the first entry.
double IsoTable::place(double u) const { return std::max(0.0, (u - u_begin_) / step_); }

bool IsoTable::is_beyond(double place) const { return !(place < static_cast<double>(value_.size() - 1)); }

double IsoTable::lower(double u) const {
  const double at = place(u);
  return is_beyond(at) ? beyond(lower_) : on_lines(lower_, at);
}

double IsoTable::upper(double u) const {
  const double at = place(u);
  return is_beyond(at) ? std::numeric_limits<double>::infinity() : on_lines(upper_, at);
}

double IsoTable::margin(double x, double y) const { return lower(u_of(x, y)) - v_of(x, y); }

IsoTable::Point IsoTable::point(int entry) const {
  const TurnedLine line{u_begin_ + entry * step_, sin_, cos_};
  const double v = value_[static_cast<std::size_t>(entry)];
  return {line.x(v), line.y(v)};
}

bool IsoTable::outside(double x_low, double x_high, double y_high) const {
  if (!(x_high < 1e30) || !(y_high < 1e30)) return false;
  return margin(x_high, y_high) > 0 && (!two_sided_ || margin(x_low, y_high) > 0);
}

bool IsoTable::inside(double x_low, double y_low) const {
  if (two_sided_) return x_low > critical_ * (1 + 1e-5);  // C rises in x from the critical field on, and in y
  return v_of(x_low, y_low) > upper(u_of(x_low, y_low));
}

}  // namespace marrow
