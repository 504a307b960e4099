#include "field/trace/curve/turned_curve.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "field/blend/correction/correction.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

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

}  // namespace

double critical_field_of(const Correction& correction) {
  return rising_root([&](double x) { return correction.value(x, 0) - 1; }, 1e-3, 8);
}

double TurnedLine::first_v() const {
  double v = 0;
  if (sin_theta > 1e-12) v = std::max(v, u * cos_theta / sin_theta);
  if (cos_theta > 1e-12) v = std::max(v, -u * sin_theta / cos_theta);
  return v;
}

double turn_for(double least, double middle) {
  constexpr double least_turn = 0.3, turn_below_zero = 0.1;
  return least < 0 ? turn_below_zero : std::max(middle, least_turn);
}

double usual_gradient(const Correction& correction) { return 6.0 * (correction.degree() - 1); }

TurnedCurve::TurnedCurve(const Correction& correction, double critical_field, double turn, UpToGradient up_to)
    : correction_(correction), sin_(sin(turn)), cos_(cos(turn)) {
  if (turn >= std::numbers::pi / 2 - 1e-12) {
    sin_ = 1;
    cos_ = 0;
  }
  begin_ = -critical_field * cos_;
  // The far end: where the curve nears the axis x = 0, or else (alpha near pi/2) where y is as large as asked for.
  const double y_end = rising_root([&](double y) { return correction.value(TurnedLine::least_x, y) - 1; }, 0,
                                   usual_gradient(correction));
  // Without a turn u = -x ends at 0; the table goes a little further, so that x = 0 lies inside it.
  end_ = sin_ > 0 ? std::min(y_end, up_to.largest) * sin_ : 0.01;
  ends_at_axis_ = sin_ > 0 && y_end < up_to.largest;
}

std::optional<double> TurnedCurve::kink() const {
  double v = root(begin_);  // of the last place, from where the next one is found
  return border(
      [&](double u) {
        const TurnedLine line = line_of(u);
        v = place(u, v).v;
        return correction_.in_cavity_branch(line.x(v), line.y(v));
      },
      begin_, end_);
}

// On the axis x = 0 all fields are above it, as they should be: the curve itself comes in like a high root, and no
// slope of it would do.
double TurnedCurve::value(double u) const { return ends_at_axis_ && u >= end_ ? u * cos_ / sin_ : root(u); }

// A step that is no longer than settled leaves an error of its square.
TurnedCurve::Place TurnedCurve::place(double u, double guess) const {
  constexpr double settled = 1e-7;
  constexpr int most_steps = 6;
  const double first = line_of(u).first_v();
  double v = std::max(guess, first);
  for (int k = 0; k < most_steps && !(ends_at_axis_ && u >= end_); ++k) {
    const CorrectionPartials c = partials(u, v);
    Place here = told_by(c, v);
    if (!(here.growth > 0 && std::isfinite(here.growth))) break;
    here.v = std::max(first, v - (c.value - 1) / here.growth);
    if (std::fabs(here.v - v) <= settled * (1 + std::fabs(v))) return here;
    v = here.v;
  }
  v = value(u);
  return told_by(partials(u, v), v);
}

double TurnedCurve::height(double u, double v, const std::array<double, 2>& growth) const {
  constexpr double is_near = 1e-3, alike = 4.0 / 3;
  const auto [least, most] = std::minmax(growth[0], growth[1]);
  if (!(least > 0 && most < alike * least)) return v - value(u);
  const double above = excess(u, v);
  return std::fabs(above) < is_near ? above / least : v - value(u);
}

double TurnedCurve::excess(double u, double v) const {
  const TurnedLine line = line_of(u);
  return correction_.value(line.x(v), line.y(v)) - 1;
}

CorrectionPartials TurnedCurve::partials(double u, double v) const {
  const TurnedLine line = line_of(u);
  return correction_.partials(line.x(v), line.y(v));
}

// Along the curve C_x dx + C_y dy = 0.
TurnedCurve::Place TurnedCurve::told_by(const CorrectionPartials& c, double v) const {
  const double growth = sin_ * c.df + cos_ * c.dG;
  return {v, (cos_ * c.df - sin_ * c.dG) / growth, growth};
}

double TurnedCurve::root(double u) const {
  const double first = line_of(u).first_v();
  return rising_root([&](double v) { return excess(u, v); }, first, first + 4);
}

}  // namespace marrow
