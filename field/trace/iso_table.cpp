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
  for (int i = 0; i < 80 && high - low > 1e-13 * (1 + std::fabs(high)); ++i) {
    double mid = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(mid > low && mid < high) || i % 8 == 7) mid = 0.5 * (low + high);
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
template <class InBranch>
Steps steps_over(double begin, double end, int entry_count, const InBranch& in_branch) {
  const Steps even{(end - begin) / (entry_count - 1), entry_count};
  const auto kink = border(in_branch, begin, end);
  const double before = kink ? std::ceil((*kink - begin) / even.length) : 0;
  if (!(before >= fewest_steps_to_kink)) return even;
  const double length = (*kink - begin) / before;
  return {length, 1 + static_cast<int>(std::ceil((end - begin) / length))};
}

}  // namespace

double critical_field_of(const Correction& correction) {
  return rising_root([&](double x) { return correction.value(x, 0) - 1; }, 1e-3, 8);
}

IsoTable::IsoTable(const Correction& correction, double alpha, int entry_count)
    : critical_(critical_field_of(correction)), two_sided_(alpha < 0) {
  const double theta = std::max(alpha, 0.0);
  const bool sum = alpha >= std::numbers::pi / 2 - 1e-12;
  sin_ = sum ? 1 : sin(theta);
  cos_ = sum ? 0 : cos(theta);
  const auto excess = [&](double x, double y) { return correction.value(x, y) - 1; };

  const auto root = [&](double u) {
    const TurnedLine line{u, sin_, cos_};
    const double v0 = line.first_v();
    return rising_root([&](double v) { return excess(line.x(v), line.y(v)); }, v0, v0 + 4);
  };
  // The far end: where the curve nears the axis x = 0, or else (alpha near pi/2) where y is six times the
  // gradient of the reference curve at the iso-value; no field of positive sources comes near either.
  const double largest_y = 6.0 * (correction.degree() - 1);
  const double y_end = rising_root([&](double y) { return excess(least_x, y); }, 0, largest_y);
  u_begin_ = -critical_ * cos_;
  // With theta = 0, u = -x ends at 0; the table goes a little further, so that x = 0 lies inside it.
  const double u_end = sin_ > 0 ? std::min(y_end, largest_y) * sin_ : 0.01;
  const Steps steps = steps_over(u_begin_, u_end, entry_count, [&](double u) {
    const TurnedLine line{u, sin_, cos_};
    const double v = root(u);
    return correction.in_cavity_branch(line.x(v), line.y(v));
  });
  step_ = steps.length;
  entry_count = steps.entry_count;
  // Behind the axis x = 0, in the last step, it goes on straight: no field comes there.
  const bool ends_at_axis = sin_ > 0 && y_end < largest_y;
  const double at_end = root(u_end), end_slope = (at_end - root(u_end - step_)) / step_;
  const auto curve = [&](double u) { return ends_at_axis && u > u_end ? at_end + end_slope * (u - u_end) : root(u); };

  const auto count = static_cast<std::size_t>(entry_count);
  std::vector<double> value(count), below(count, 0), above(count, 0);
  for (int i = 0; i < entry_count; ++i) value[static_cast<std::size_t>(i)] = curve(u_begin_ + i * step_);
  peak_x_ = -(u_begin_ + step_ * static_cast<double>(std::max_element(value.begin(), value.end()) - value.begin()));
  // Between entries the straight line is off by at most twice what three probes find: the error of linear
  // interpolation is a smooth arch over a step, and where the curve has a kink the probes stand within a
  // quarter of a step of it.
  for (std::size_t i = 0; i + 1 < value.size(); ++i) {
    double low = 0, high = 0;
    for (int k = 1; k <= probes_per_step; ++k) {
      const double fraction = static_cast<double>(k) / (probes_per_step + 1);
      const double exact = curve(u_begin_ + (static_cast<double>(i) + fraction) * step_);
      const double error = exact - (value[i] + (value[i + 1] - value[i]) * fraction);
      low = std::min(low, 2 * error);
      high = std::max(high, 2 * error);
    }
    for (const std::size_t j : {i, i + 1}) {
      below[j] = std::min(below[j], low);
      above[j] = std::max(above[j], high);
    }
  }
  // dV/du at the entries, from the partials: along the curve C_x dx + C_y dy = 0.
  for (int i = 0; i < entry_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const TurnedLine line{u_begin_ + i * step_, sin_, cos_};
    const auto c = correction.partials(line.x(value[k]), line.y(value[k]));
    const double slope = (cos_ * c.df - sin_ * c.dG) / (sin_ * c.df + cos_ * c.dG);
    const std::size_t next = std::min<std::size_t>(k + 1, value.size() - 1);
    const double chord = (value[next] - value[next - 1]) / step_;
    slope_.push_back(static_cast<float>(std::isfinite(slope) ? slope : chord));
  }
  constexpr double rounding = 4e-7;  // of float entries and of their interpolation in float, relative
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double slack = rounding * (1 + std::fabs(value[i]));
    value_.push_back(static_cast<float>(value[i]));
    lower_.push_back(static_cast<float>(value[i] + below[i] - slack));
    upper_.push_back(static_cast<float>(value[i] + above[i] + slack));
  }
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
          .critical = static_cast<float>(critical_ * (1 + 1e-6))};
}

double IsoTable::lower(double u) const {
  const double at = (u - u_begin_) / step_;
  if (at <= 0) return lower_.front();
  if (!(at < static_cast<double>(value_.size() - 1))) return -std::numeric_limits<double>::infinity();
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
  constexpr double beyond = -std::numeric_limits<double>::infinity();
  if (!(at < static_cast<double>(value_.size() - 1))) return {beyond, beyond};
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
  if (!(at < static_cast<double>(value_.size() - 1))) return -std::numeric_limits<double>::infinity();
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
