#include "field/tree/nodes/sharp_corner.h"

namespace marrow {

// Halving between the crisp and the soft operation, which enclose this one. Iso-curves do not cross, so that the side
// of the iso-curve at c that the point is on tells the side of the solution that c is on.
double SharpCorner::solve(double x, double y) const {
  if (is_line(x, y, b)) return x;
  if (is_line(y, x, a)) return y;
  const double crisp = is_union() ? max(x, y) : min(x, y), soft = above().value(x, y);
  double beyond = crisp, within = is_union() ? min(soft, 1.0) : soft;  // where U^2 + V^2 > 1, and where not
  for (int i = 0; i < 200; ++i) {
    const double c = 0.5 * (beyond + within);
    if (c == beyond || c == within) break;
    const auto p = on_arc(x, y, c);
    (square(p.U) + square(p.V) > 1 ? beyond : within) = c;
  }
  return beyond;
}

// Widened until the equation itself says so on both sides; never beyond the crisp operation on one.
Interval SharpCorner::enclosed_at(double x, double y) const {
  if (is_line(x, y, b)) return x;
  if (is_line(y, x, a)) return y;
  if (!inside(x, y)) return Interval(1) + above().value(Interval(x) - Interval(1), Interval(y) - Interval(1));
  const double c = solve(x, y), crisp = is_union() ? max(x, y) : min(x, y);
  const auto excess = [&](double at) {
    const auto p = on_arc(Interval(x), Interval(y), Interval(at));
    return square(p.U) + square(p.V) - Interval(1);
  };
  const double to_crisp = is_union() ? -1 : 1;
  double near = c, far = c;
  for (double step = 1e-15; step < 1; step *= 4) {
    near = c + to_crisp * step * c;
    if ((near - crisp) * to_crisp >= 0) near = crisp;
    if (near == crisp || excess(near).lo > 0) break;
  }
  for (double step = 1e-15; step < 1; step *= 4) {
    far = c - to_crisp * step * c;
    if (far >= 1) far = 1;
    if (far == 1 || excess(far).hi < 0) break;
    if (step > 0.2) far = is_union() ? 1 : 0;
  }
  return {std::min(near, far), std::max(near, far)};
}

// Below the surface from the equation, which also holds where one of U, V is 0 and the other 1.
EllipseCorner::Partials SharpCorner::partials(const Interval& x, const Interval& y, const Interval& c) const {
  if (is_line(x, y, b)) return {1, 0};
  if (is_line(y, x, a)) return {0, 1};
  const bool may_be_below = inside(x.lo, y.lo), may_be_above = !inside(x.hi, y.hi);
  EllipseCorner::Partials under{{0, 1}, {0, 1}}, over{{0, 1}, {0, 1}};
  if (may_be_below) {
    auto p = on_arc(x, y, clamped(c, {0, 1}));
    p.U = clamped(p.U, {0, 1});
    p.V = clamped(p.V, {0, 1});
    const Interval all = fall(p);
    under = {clamped(p.U * Interval(1 / (1 - a)) / all, {0, 1}), clamped(p.V * Interval(1 / (1 - b)) / all, {0, 1})};
  }
  if (may_be_above) over = above().partials(x - Interval(1), y - Interval(1));
  if (!may_be_above) return under;
  if (!may_be_below) return over;
  return {hull(under.x, over.x), hull(under.y, over.y)};
}

}  // namespace marrow
