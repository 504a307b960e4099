#include "field/blend/local/source_rule.h"

#include <algorithm>
#include <cmath>

#include "field/math/elementary.h"

namespace marrow {
namespace {

// Ellipses reach to this share of the distance; of an arc, whose real shift takes its share too, to less. Larger ones
// converge faster from larger bounds: 0.6 and 0.8 take about as many nodes. An ellipse of the reach x holds no place
// without distance where x < (1 - shift) / sqrt(2); of an arc with a radius R the shift is sqrt(R^2 + x^2) - R, which
// is nearly x where R is small: x < 0.41.
constexpr double reach_of_line = 0.7;
double reach_of_arc(double radius) { return radius < 0.3 ? 0.35 : 0.45; }
// Longer pieces are cut at once.
constexpr double longest = 1.3;

// An ellipse with the half axes a and b, and how far sources move over it, over the distance.
struct Ellipse {
  double a, b;
  double along;      // to the parameter 1
  double shift = 0;  // of the middle of an arc
};

std::optional<Ellipse> ellipse_for(const RulePiece& piece, double distance) {
  const double h = piece.half_length / distance, lift = piece.half_lift / distance;
  if (!(h <= longest)) return {};
  if (piece.half_angle == 0) {
    const double along = std::max(std::sqrt(h * h + lift * lift), 1e-6), b = reach_of_line / along;
    return Ellipse{std::sqrt(1 + b * b), b, along};
  }
  const double R = h / piece.half_angle, reach = reach_of_arc(R);
  const double turn = asinh(reach / R), b = turn / piece.half_angle, along = reach / b;
  return Ellipse{std::sqrt(1 + b * b), b, std::sqrt(along * along + lift * lift), R * (cosh(turn) - 1)};
}

// The least |D^2| over the ellipse, over that of the distance. At a cos phi + i b sin phi, u = cos phi, the source is
// along (a u - 1) nearer at most, and its imaginary part along b sin phi; between u = 1/a and 1 that is a parabola.
double least_square(const Ellipse& e) {
  const double clear = 1 - e.shift, sideways = e.along * e.b;
  if (!(clear - e.along * (e.a - 1) > 0)) return 0;
  const double lowest = e.a * (clear + e.along) / (e.along * (e.a * e.a + e.b * e.b));
  const double u = std::clamp(lowest, 1 / e.a, 1.0), real = clear - e.along * (e.a * u - 1);
  return std::min(clear * clear - sideways * sideways, real * real - sideways * sideways * (1 - u * u));
}

}  // namespace

std::optional<int> rule_nodes(const RulePiece& piece, double distance, double relative) {
  const auto e = ellipse_for(piece, distance);
  if (!e) return {};
  const double square = least_square(*e), m = piece.exponent;
  if (!(square > 1e-4)) return {};
  const double wider = (piece.radius + piece.half_radius * e->a) / (piece.radius + piece.half_radius);
  // the logarithm of M over the reference, the larger of the two integrands'
  const double moved = 1 + e->along * (e->a + e->b) + e->shift;
  double most = log(4 / relative * moved * (piece.widens ? 1 + e->a : 1)) - 0.5 * (m + 2) * log(square);
  if (wider > 1) most += (piece.power + 1) * log(wider);
  const double rho = e->a + e->b;
  most -= log(1 - 1 / rho);
  const double nodes = std::ceil(0.5 * most / log(rho));
  if (!(nodes <= most_rule_nodes)) return {};
  return std::max(1, static_cast<int>(nodes));
}

}  // namespace marrow
