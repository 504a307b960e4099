#include "field/trace/shares/angle_field.h"

#include <algorithm>
#include <cmath>

#include "field/blend/blend_field.h"

namespace marrow {

std::optional<AngleRange> angle_range(const BlendField& blend) {
  if (single_angle(blend)) return {};
  AngleRange range{2, -2};  // wider than any
  blend.for_each_list([&](const auto& list) {
    for (const auto* alphas : {&list.alphas, &list.alphas_to})
      for (const double alpha : *alphas) range = {std::min(range.least, alpha), std::max(range.most, alpha)};
  });
  for (const DirectionBounds& b : blend.direction_bounds)
    range = {std::min({range.least, b.least, b.most}), std::max({range.most, b.least, b.most})};
  return range;
}

namespace {

// Of the angles of a segment at a place on it: linear from its begin on.
double angle_at(const PrimitiveList<SegmentSkeleton>& segments, std::size_t i, const Vec3d& place) {
  if (!segments.angle_varies(i)) return segments.alphas[i];
  const SegmentSkeleton& s = segments.skeletons[i];
  const Vec3d along = s.to - s.from;
  const double t = std::clamp(dot(place - s.from, along) / length_squared(along), 0.0, 1.0);
  return std::lerp(segments.alphas[i], segments.alphas_to[i], t);
}

}  // namespace

std::vector<Piece> angle_pieces(const BlendField& blend, const AngleRange& range, const std::vector<Piece>& pieces) {
  std::vector<Piece> weighted;
  const auto share_of = [&](double alpha) { return std::max(0.0, (alpha - range.least) / (range.most - range.least)); };
  for (const Piece& p : pieces) {
    const double from = share_of(p.is_point() ? blend.points.alphas[p.primitive]
                                              : angle_at(blend.segments, p.primitive, p.from)),
                 to = p.is_point() ? from : share_of(angle_at(blend.segments, p.primitive, p.to));
    if (std::max(from, to) > 0) weighted.push_back(p.scaled(from, to));
  }
  return weighted;
}

}  // namespace marrow
