#include "field/trace/sources/source_emitter.h"

#include <algorithm>
#include <cmath>

#include "field/math/elementary.h"

namespace marrow {
namespace {

// How far two boxes are apart; a lower bound of the distance of what they hold.
double separation(const Box3& a, const Box3& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double gap = std::max({0.0, a.lower[i] - b.upper[i], b.lower[i] - a.upper[i]});
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

}  // namespace

RuleFinder::RuleFinder(const PieceCutter& cutter, const NearFar& precision, const Vec3d& center, double half)
    : cutter_(cutter), precision_(precision), center_(center), half_(half) {
  const Vec3d h{half, half, half};
  box_ = {center - h, center + h};
}

// Cut in halves until a rule is certified at the distance from which the field matters: nearer than
// inside_distance the surface cannot be. The depth ends where a part is a thousandth of its piece.
void RuleFinder::find(const Piece& whole, double share,
                      const std::function<void(const Piece& part, int nodes)>& found) {
  struct Range {
    double begin, end;
  };
  Range stack[24];
  int count = 0;
  stack[count++] = {0, 1};
  while (count > 0) {
    const Range r = stack[--count];
    const Piece part = r.end - r.begin == 1 ? whole : cutter_.part(whole, r.begin, r.end);
    const double ball = distance(part, center_) - half_ * std::sqrt(3.0);
    const double d = std::max({ball, separation(part.box(), box_), whole.inside_distance});
    const auto rule = precision_.rule_for(part, d, share);
    if (rule.within || r.end - r.begin < 1e-3) {
      found(part, rule.nodes);
      f_error += rule.error.field;
      gradient_error += rule.error.gradient;
      continue;
    }
    const double mid = 0.5 * (r.begin + r.end);
    stack[count++] = {mid, r.end};
    stack[count++] = {r.begin, mid};
  }
}

void SourceEmitter::emit(const Piece& piece, double share) {
  if (piece.is_point()) return add_nodes(piece, 1, center_, half_, degree_, points);
  rules.find(piece, share,
             [&](const Piece& part, int nodes) { add_nodes(part, nodes, center_, half_, degree_, curves); });
}

CurvePiece curve_piece(const Piece& piece, int nodes, const Vec3d& center, double half, int degree) {
  const double scale = 1 / half;
  const Vec3d from = (piece.from - center) * scale, along = (piece.to - piece.from) * scale;
  const auto single = [](double v) { return static_cast<float>(v); };
  return {.from = {single(from.x), single(from.y), single(from.z)},
          .along = {single(along.x), single(along.y), single(along.z)},
          .radius = single(piece.radius_from * scale),
          .taper = single((piece.radius_to - piece.radius_from) * scale),
          .unit = single(piece.mass / integer_power(piece.radius, degree - 1) * scale),
          .nodes = nodes};
}

}  // namespace marrow
