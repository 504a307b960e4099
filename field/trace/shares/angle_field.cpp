#include "field/trace/shares/angle_field.h"

#include <algorithm>

#include "field/blend/blend_field.h"

namespace marrow {

std::optional<AngleRange> angle_range(const BlendField& blend) {
  if (single_angle(blend)) return {};
  AngleRange range{2, -2};  // wider than any
  blend.for_each_list([&](const auto& list) {
    for (const double alpha : list.alphas) range = {std::min(range.least, alpha), std::max(range.most, alpha)};
  });
  for (const DirectionBounds& b : blend.direction_bounds)
    range = {std::min({range.least, b.least, b.most}), std::max({range.most, b.least, b.most})};
  return range;
}

std::vector<Piece> angle_pieces(const BlendField& blend, const AngleRange& range, const std::vector<Piece>& pieces) {
  std::vector<Piece> weighted;
  for (const Piece& p : pieces) {
    const double alpha = (p.is_point() ? blend.points.alphas : blend.segments.alphas)[p.primitive];
    const double share = (alpha - range.least) / (range.most - range.least);
    if (share > 0) weighted.push_back(p.scaled(share));
  }
  return weighted;
}

}  // namespace marrow
