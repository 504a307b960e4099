#include "field/trace/iso_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "field/blend/correction.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr int probes_per_step = 3;

// Else there would be more than twice as many entries.
constexpr double fewest_steps_to_kink = 2;

// Of the table of one angle.
constexpr int fewest_entries = 2048, most_entries = 8192;
// The error of C on the straight lines between entries that is not worth more of them, as sums in float are off by as
// much; and how many lines may have a larger one: without cavity those where G is nearly 0 and the slope of C not
// bounded.
constexpr double allowed_error = 5e-7;
constexpr int most_rough_steps = 12;

// The turn for an angle near or below 0. Where G is nearly 0 the curve runs along the axis of G, and over x alone it
// would begin as steeply as a root; below 0 it may rise in x by up to 6, so that its tangent may not turn far.
constexpr double least_turn = 0.3, turn_below_zero = 0.1;

double turn_of(double alpha) { return alpha < 0 ? turn_below_zero : std::max(alpha, least_turn); }

// The smallest v in [low, high] with inside(v), by bisection with a value: `excess` is C - 1 along v, rising.
template <class Excess>
double rising_root(const Excess& excess, double low, double high) {
  double at_low = excess(low), at_high = excess(high);
  if (at_low >= 0) return low;
  for (int i = 0; at_high < 0 && i < 60; ++i) {
    low = high;
    at_low = at_high;
    high = high * 2 + 1;
    at_high = excess(high);
  }
  if (at_high < 0) return std::numeric_limits<double>::infinity();
  int side = 0;  // Illinois' variant of regula falsi: halve the end that stays
  for (int i = 0; i < 200 && high - low > 1e-13 * (1 + std::fabs(high)); ++i) {
    double mid = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(mid > low && mid < high) || i % 4 == 3) mid = 0.5 * (low + high);
    const double at_mid = excess(mid);
    if (at_mid < 0) {
      low = mid;
      at_low = at_mid;
      if (side == -1) at_high /= 2;
      side = -1;
    } else {
      high = mid;
      at_high = at_mid;
      if (side == 1) at_low /= 2;
      side = 1;
      if (at_mid == 0) return mid;
    }
  }
  return 0.5 * (low + high);
}

// The operator is 0 at f = 0 by definition; the curve is that of its limit.
constexpr double least_x = 1e-9;

// Points of the quarter plane x, y >= 0 on the line of given u.
struct TurnedLine {
  double u, sin_theta, cos_theta;
  double x(double v) const { return std::max(least_x, v * sin_theta - u * cos_theta); }
  double y(double v) const { return std::max(0.0, u * sin_theta + v * cos_theta); }
  double first_v() const {
    double v = 0;
    if (sin_theta > 1e-12) v = std::max(v, u * cos_theta / sin_theta);
    if (cos_theta > 1e-12) v = std::max(v, -u * sin_theta / cos_theta);
    return v;
  }
};

// The u where the curve comes to the border of a branch of the operator, to a rounding: `in_branch` tells for a u. The
// border is met once or not at all.
template <class InBranch>
std::optional<double> border(const InBranch& in_branch, double begin, double end) {
  constexpr int looks = 64;
  const bool first = in_branch(begin);
  double low = begin, high = begin;
  for (int i = 1; i <= looks && in_branch(high) == first; ++i) {
    low = high;
    high = begin + (end - begin) * i / looks;
  }
  if (in_branch(high) == first) return {};
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (in_branch(middle) == first ? low : high) = middle;
  }
  return high;
}

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

// The curve C = 1 in turned coordinates, from where it meets the axis G = 0 on.
class TurnedCurve {
 public:
  TurnedCurve(const Correction& correction, double critical, double turn)
      : correction_(correction), sin_(sin(turn)), cos_(cos(turn)) {
    if (turn >= std::numbers::pi / 2 - 1e-12) {
      sin_ = 1;
      cos_ = 0;
    }
    begin_ = -critical * cos_;
    // The far end: where the curve nears the axis x = 0, or else (alpha near pi/2) where y is six times the gradient of
    // the reference curve at the iso-value; no field of positive sources comes near either.
    const double largest_y = 6.0 * (correction.degree() - 1);
    const double y_end = rising_root([&](double y) { return correction.value(least_x, y) - 1; }, 0, largest_y);
    // Without a turn u = -x ends at 0; the table goes a little further, so that x = 0 lies inside it.
    end_ = sin_ > 0 ? std::min(y_end, largest_y) * sin_ : 0.01;
    ends_at_axis_ = sin_ > 0 && y_end < largest_y;
  }
  bool ends_at_axis() const { return ends_at_axis_; }
  double sine() const { return sin_; }
  double cosine() const { return cos_; }
  double begin() const { return begin_; }
  double end() const { return end_; }

  // The u of the kink.
  std::optional<double> kink() const {
    return border(
        [&](double u) {
          const TurnedLine line = line_of(u);
          const double v = root(u);
          return correction_.in_cavity_branch(line.x(v), line.y(v));
        },
        begin_, end_);
  }

  // V(u), which is probably within `known` of a guess. From the axis x = 0 on it is that axis, so that all fields there
  // are above it, as they should: the curve itself comes in like a high root, and no slope of it would do.
  double value(double u, double guess, double known) const {
    if (ends_at_axis_ && u >= end_) return u * cos_ / sin_;
    const double low = std::max(line_of(u).first_v(), guess - known), high = guess + known;
    if (!(low < high) || !(excess(u, low) < 0) || !(excess(u, high) >= 0)) return root(u);
    return rising_root([&](double v) { return excess(u, v); }, low, high);
  }

  TurnedLine line_of(double u) const { return {u, sin_, cos_}; }

 private:
  double excess(double u, double v) const {
    const TurnedLine line = line_of(u);
    return correction_.value(line.x(v), line.y(v)) - 1;
  }
  double root(double u) const {
    const double first = line_of(u).first_v();
    return rising_root([&](double v) { return excess(u, v); }, first, first + 4);
  }

  const Correction& correction_;
  double sin_, cos_, begin_, end_;
  bool ends_at_axis_;
};

// V at even steps, and how far straight lines between them are below and above the curve around each.
struct Entries {
  double step = 1;
  std::vector<double> value{}, below{}, above{};
  std::vector<double> slope{};  // V' from the partials
  int rough_steps = 0;          // where C is off by more than allowed_error
};

void find_values(const TurnedCurve& curve, Entries& e) {
  for (std::size_t i = 0; i < e.value.size(); ++i) {
    // By the parabola through the last three.
    const double guess = i < 3 ? 0 : 3 * (e.value[i - 1] - e.value[i - 2]) + e.value[i - 3];
    const double known = i < 3 ? 0 : 1e-4 * e.step;
    e.value[i] = curve.value(curve.begin() + static_cast<double>(i) * e.step, guess, known);
  }
}

// dV/du from the partials: along the curve C_x dx + C_y dy = 0. Returns dC/dv at each entry.
std::vector<double> find_slopes(const TurnedCurve& curve, const Correction& correction, Entries& e) {
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
void find_errors(const TurnedCurve& curve, const std::vector<double>& growth, Entries& e) {
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

Entries entries_of(const TurnedCurve& curve, const Correction& correction, const Steps& steps) {
  Entries e{.step = steps.length};
  e.value.resize(static_cast<std::size_t>(steps.entry_count));
  find_values(curve, e);
  find_errors(curve, find_slopes(curve, correction, e), e);
  return e;
}

}  // namespace

double critical_field_of(const Correction& correction) {
  return rising_root([&](double x) { return correction.value(x, 0) - 1; }, 1e-3, 8);
}

IsoTable::IsoTable(const Correction& correction, double alpha)
    : IsoTable(correction, alpha, turn_of(alpha), fewest_entries, most_entries) {}

IsoTable::IsoTable(const Correction& correction, double alpha, int entry_count)
    : IsoTable(correction, alpha, std::max(alpha, 0.0), entry_count, entry_count) {}

IsoTable::IsoTable(const Correction& correction, double alpha, double turn, int fewest, int most)
    : critical_(critical_field_of(correction)), two_sided_(alpha < 0) {
  const TurnedCurve curve(correction, critical_, turn);
  sin_ = curve.sine();
  cos_ = curve.cosine();
  u_begin_ = curve.begin();
  ends_at_axis_ = curve.ends_at_axis();
  const auto kink = curve.kink();
  Entries e;
  for (int count = fewest; count <= most; count *= 2) {
    e = entries_of(curve, correction, steps_over(curve.begin(), curve.end(), count, kink));
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
// (C = 1 where v is that of the reference curve), for the paper's it rises; checked numerically.
double IsoTable::beyond(const std::vector<float>& table) const {
  if (ends_at_axis_) return -std::numeric_limits<double>::infinity();
  return table.back();
}

double IsoTable::lower(double u) const {
  const double at = (u - u_begin_) / step_;
  if (at <= 0) return lower_.front();
  if (!(at < static_cast<double>(value_.size() - 1))) return beyond(lower_);
  const auto i = static_cast<std::size_t>(at);
  const double fraction = at - static_cast<double>(i);
  return lower_[i] + (static_cast<double>(lower_[i + 1]) - lower_[i]) * fraction;
}

double IsoTable::upper(double u) const {
  const double at = (u - u_begin_) / step_;
  if (at <= 0) return upper_.front();
  if (!(at < static_cast<double>(value_.size() - 1))) return std::numeric_limits<double>::infinity();
  const auto i = static_cast<std::size_t>(at);
  const double fraction = at - static_cast<double>(i);
  return upper_[i] + (static_cast<double>(upper_[i + 1]) - upper_[i]) * fraction;
}

double IsoTable::margin(double x, double y) const { return lower(y * sin_ - x * cos_) - (x * sin_ + y * cos_); }

IsoTable::Margins IsoTable::margins(double x, double y) const {
  const double at = std::max(0.0, (y * sin_ - x * cos_ - u_begin_) / step_), v = x * sin_ + y * cos_;
  if (!(at < static_cast<double>(value_.size() - 1))) return {beyond(value_) - v, beyond(lower_) - v};
  const auto i = static_cast<std::size_t>(at);
  const double fraction = at - static_cast<double>(i);
  const auto between = [&](const std::vector<float>& table) {
    return table[i] + (static_cast<double>(table[i + 1]) - table[i]) * fraction;
  };
  return {between(value_) - v, between(lower_) - v};
}

// The residual V(u) - v falls where C grows: -d/dx = sin + V' cos, -d/dy = cos - V' sin.
IsoTable::Slope IsoTable::gradient(double x, double y) const {
  const double at =
      std::clamp((y * sin_ - x * cos_ - u_begin_) / step_, 0.0, static_cast<double>(value_.size()) - 1.001);
  const auto i = static_cast<std::size_t>(at);
  const double fraction = at - static_cast<double>(i);
  const double slope = slope_[i] + (static_cast<double>(slope_[i + 1]) - slope_[i]) * fraction;
  return {sin_ + slope * cos_, cos_ - slope * sin_};
}

double IsoTable::nominal(double x, double y) const {
  const double at = std::max(0.0, (y * sin_ - x * cos_ - u_begin_) / step_), v = x * sin_ + y * cos_;
  if (!(at < static_cast<double>(value_.size() - 1))) return beyond(value_) - v;
  const auto i = static_cast<std::size_t>(at);
  const double fraction = at - static_cast<double>(i);
  return value_[i] + (static_cast<double>(value_[i + 1]) - value_[i]) * fraction - v;
}

IsoTable::Point IsoTable::point(int entry) const {
  const TurnedLine line{u_begin_ + entry * step_, sin_, cos_};
  const double v = value_[static_cast<std::size_t>(entry)];
  return {line.x(v), line.y(v)};
}

void IsoTable::lower_around(const Point& p, double by) {
  const double at = std::max(0.0, (p.y * sin_ - p.x * cos_ - u_begin_) / step_);
  const auto last = value_.size() - 1, i = std::min(last, static_cast<std::size_t>(at));
  for (std::size_t k = i > 2 ? i - 2 : 0; k <= std::min(last, i + 3); ++k)
    lower_[k] = std::min(lower_[k], static_cast<float>(value_[k] - by));
}

bool IsoTable::outside(double x_low, double x_high, double y_high) const {
  if (!(x_high < 1e30) || !(y_high < 1e30)) return false;
  return margin(x_high, y_high) > 0 && (!two_sided_ || margin(x_low, y_high) > 0);
}

bool IsoTable::inside(double x_low, double y_low) const {
  if (two_sided_) return x_low > critical_ * (1 + 1e-5);  // C rises in x from the critical field on, and in y
  return x_low * sin_ + y_low * cos_ > upper(y_low * sin_ - x_low * cos_);
}

}  // namespace marrow
