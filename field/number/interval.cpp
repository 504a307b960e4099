#include "field/number/interval.h"

#include <numbers>

namespace marrow {
namespace {

// Whether some (4 k + quarter) pi / 2 may lie in the interval; generous by far more than the rounding of pi.
bool may_contain_quarter(const Interval& a, int quarter) {
  constexpr double turn = 2 * std::numbers::pi;
  const double shift = quarter * (std::numbers::pi / 2);
  const double slack = 1e-15 * (4 + std::fabs(a.lo) + std::fabs(a.hi));
  return std::floor((a.hi + slack - shift) / turn) >= std::ceil((a.lo - slack - shift) / turn);
}

Interval wave(const Interval& a, double at_lo, double at_hi, int top_quarter) {
  Interval w{rounding::down(std::min(at_lo, at_hi), 2), rounding::up(std::max(at_lo, at_hi), 2)};
  if (may_contain_quarter(a, top_quarter) || w.hi > 1) w.hi = 1;
  if (may_contain_quarter(a, top_quarter + 2) || w.lo < -1) w.lo = -1;
  return w;
}

}  // namespace

IntervalSinCos sincos(const Interval& a) {
  // Beyond 1e6 turns the slack above would no longer be small; nothing here turns that far.
  if (!(a.width() < 2 * std::numbers::pi) || !(std::fabs(a.lo) < 1e6)) return {{-1, 1}, {-1, 1}};
  const SinCos l = sincos(a.lo), h = sincos(a.hi);
  return {wave(a, l.sin, h.sin, 1), wave(a, l.cos, h.cos, 0)};
}

}  // namespace marrow
