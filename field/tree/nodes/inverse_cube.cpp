#include "field/tree/nodes/inverse_cube.h"

namespace marrow::inverse_cube {
namespace {

// (h2 + t^2)^(-3/2), the integrand.
Interval integrand(const Interval& h2, const Interval& t) {
  const Interval d2 = h2 + square(t);
  return Interval(1) / (d2 * sqrt(d2));
}

// The integral of (h2 + t^2)^(-5/2) at a point: the closed form, and, as it cancels near the line, a mean of the
// inverse cube's integral over 1/(h2 + t^2). Both are enclosures; so is what they have in common.
Interval fifth_power(double h, double a, double b) {
  if (!(b > a)) return 0;
  const Interval h2 = h;
  const auto primitive = [&](const Interval& t) {
    const Interval d2 = h2 + square(t);
    return t * (Interval(3) * h2 + Interval(2) * square(t)) / (Interval(3) * square(h2) * d2 * sqrt(d2));
  };
  const double near = a <= 0 && b >= 0 ? 0 : std::min(std::fabs(a), std::fabs(b));
  const double far = std::max(std::fabs(a), std::fabs(b));
  const Interval mean =
      formula(h2, Interval(a), Interval(b)) / hull(h2 + square(Interval(near)), h2 + square(Interval(far)));
  return clamped(primitive(b) - primitive(a), mean);
}

}  // namespace

// A window that may be empty has the slopes of one that is or of one that is not.
Partials partials(const Interval& h2, const Interval& t1, const Interval& t2) {
  const double least = fifth_power(h2.hi, t1.hi, t2.lo).lo, most = fifth_power(h2.lo, t1.lo, t2.hi).hi;
  Partials d{Interval(-1.5) * Interval(std::max(0.0, least), std::max(0.0, most)), -integrand(h2, t1),
             integrand(h2, t2)};
  if (t2.lo <= t1.hi) {
    d.t1 = hull(d.t1, 0);
    d.t2 = hull(d.t2, 0);
  }
  return d;
}

}  // namespace marrow::inverse_cube
