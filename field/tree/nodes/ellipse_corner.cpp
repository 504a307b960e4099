#include "field/tree/nodes/ellipse_corner.h"

namespace marrow {

// Of the implicit equation of arc().
EllipseCorner::Partials EllipseCorner::partials_at(double x, double y) const {
  switch (part(x, y)) {
    case Part::Vertical:
      return {1, 0};
    case Part::Horizontal:
      return {0, 1};
    case Part::Arc:
      break;
  }
  const double s = scale(x, y);  // only directions matter
  const Interval A = a, B = b, X = x * s, Y = y * s, c = arc(X, Y);
  const Interval u = (X - A * c) / square(Interval(1) - A), v = (Y - B * c) / square(Interval(1) - B);
  const Interval all = c + A * u + B * v;
  return {clamped(u / all, {0, 1}), clamped(v / all, {0, 1})};
}

EllipseCorner::Partials EllipseCorner::partials(const Interval& x, const Interval& y) const {
  if (x.hi <= 0 && y.hi <= 0) return {{0, 1}, {0, 1}};  // the origin, where they have no limit
  const Partials p = partials_at(std::max(0.0, x.lo), std::max(0.0, y.hi)),
                 q = partials_at(std::max(0.0, x.hi), std::max(0.0, y.lo));
  return {hull(p.x, q.x), hull(p.y, q.y)};
}

}  // namespace marrow
