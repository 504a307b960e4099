#include "field/trace/source_emitter.h"

#include <algorithm>
#include <cmath>

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

SourceEmitter::SourceEmitter(const PieceCutter& cutter, const NearFar& precision, int degree, const Vec3d& center,
                             double half)
    : cutter_(cutter), precision_(precision), degree_(degree), center_(center), half_(half) {
  const Vec3d h{half, half, half};
  box_ = {center - h, center + h};
}

// Cut in halves until a rule is certified at the distance from which the field matters: nearer than
// inside_distance the surface cannot be. The depth ends where a part is a thousandth of its piece.
void SourceEmitter::emit(const Piece& whole, std::uint32_t index, std::vector<PieceRule>* rules) {
  if (whole.is_point()) {
    add_nodes(whole, 1, center_, half_, degree_, points);
    if (rules != nullptr) rules->push_back({.piece = index, .position = 0, .halvings = 0, .nodes = 1});
    return;
  }
  struct Range {
    double begin, end;
    int halvings, position;
  };
  Range stack[24];
  int count = 0;
  stack[count++] = {0, 1, 0, 0};
  while (count > 0) {
    const Range r = stack[--count];
    const Piece part = r.halvings == 0 ? whole : cutter_.part(whole, r.begin, r.end);
    const double ball = distance(part, center_) - half_ * std::sqrt(3.0);
    const double d = std::max({ball, separation(part.box(), box_), whole.inside_distance});
    const auto rule = precision_.rule_for(part, d, 1);
    if (rule.within || r.end - r.begin < 1e-3) {
      add_nodes(part, rule.nodes, center_, half_, degree_, curves);
      f_error += rule.error.field;
      gradient_error += rule.error.gradient;
      if (rules != nullptr)
        rules->push_back({.piece = index,
                          .position = static_cast<std::uint16_t>(r.position),
                          .halvings = static_cast<std::uint8_t>(r.halvings),
                          .nodes = static_cast<std::uint8_t>(rule.nodes)});
      continue;
    }
    const double mid = 0.5 * (r.begin + r.end);
    stack[count++] = {mid, r.end, r.halvings + 1, 2 * r.position + 1};
    stack[count++] = {r.begin, mid, r.halvings + 1, 2 * r.position};
  }
}

// Halves of halves of [0, 1] are exact numbers.
void SourceEmitter::emit_again(const Piece& whole, const PieceRule& rule) {
  const double step = std::ldexp(1.0, -rule.halvings);
  const Piece part = rule.halvings == 0 ? whole : cutter_.part(whole, rule.position * step, (rule.position + 1) * step);
  add_nodes(part, rule.nodes, center_, half_, degree_, whole.is_point() ? points : curves);
}

}  // namespace marrow
