#include "field/blend/bounds/sum/distances_in_reach.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "field/blend/primitive_visit.h"
#include "field/math/box3.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

// Relative, for what rounding of distances may hide.
constexpr double slack = 1e-12;

SegmentPlace place_seen_from(const Ball& ball, const SegmentSkeleton& s) {
  const double size = length(s.to - s.from);
  return segment_place(s, ball.center, size, (s.to - s.from) / size);
}

// The place nearest to the middle is no farther from others than by the way over its radius; and no place gets nearer
// than by the way over its own, or, in the same proportion, than the nearest one does.
SeenSegment seen_from(const Ball& ball, const SegmentSkeleton& s, std::size_t index) {
  const SegmentPlace place = place_seen_from(ball, s);
  const double e = length(place.to_point) / place.radius;
  double least = std::max(0.0, e - ball.radius / least_radius(s));
  if (s.radius_from != s.radius_to) least = std::max(least, e * (1 - ball.radius / distance_to(s, ball.center)));
  return {index, place, {least * (1 - slack), (e + ball.radius / place.radius) * (1 + slack)}};
}

// Whether another place of the strand, seen as v from the middle, is nearer than this segment all over the ball. At a
// way w from the middle the distance to it is d' + u' w or more, as distances to segments are convex, and at least that
// over the largest radius; the place is no farther than d + u w + w^2 / 2d.
bool is_behind(const SegmentSkeleton& s, const SegmentPlace& place, const Ball& ball) {
  const Vec3d own = place_seen_from(ball, {s.from, s.to, 1, 1}).to_point;  // of one radius: not scaled
  const double d = length(place.to_point), own_d = length(own), radius = largest_radius(s);
  if (!(d > 0 && own_d > 0)) return false;
  const double e = d / place.radius, own_e = own_d / radius;
  const double turn = length(own / (own_d * radius) - place.to_point / (d * place.radius));
  return own_e - e - ball.radius * (turn + 0.5 * ball.radius / (d * place.radius)) > slack * (own_e + e);
}

// The end of which the scaled distance is the least from all of the ball. It has no other minimum along the segment, so
// that an end has the least where it rises from there: where r_0 a + k D^2 < 0, D from that end, a along the segment
// and k the slope of the radius. Over a ball that is largest where its gradient leads.
std::optional<PointSkeleton> only_end(const SegmentSkeleton& s, const Ball& ball) {
  const double size = length(s.to - s.from);
  const auto is_nearest = [&](const PointSkeleton& end, const PointSkeleton& other) {
    const Vec3d u = (other.at - end.at) / size, v = ball.center - end.at;
    const double k = (other.radius - end.radius) / size;
    const double middle = end.radius * dot(u, v) + k * length_squared(v);
    const double rise =
        ball.radius * length(u * end.radius + v * (2 * k)) + std::max(k, 0.0) * ball.radius * ball.radius;
    const double terms = end.radius * length(v) + std::fabs(k) * length_squared(v);
    return middle + rise < -slack * (terms + rise);
  };
  const PointSkeleton from{s.from, s.radius_from}, to{s.to, s.radius_to};
  if (is_nearest(from, to)) return from;
  if (is_nearest(to, from)) return to;
  return {};
}

// The end that all of them have in common, if the ball sees nothing else of them.
std::optional<PointSkeleton> only_end(std::span<const SegmentSkeleton> segments, const Ball& ball) {
  std::optional<PointSkeleton> common;
  for (const SegmentSkeleton& s : segments) {
    const auto end = only_end(s, ball);
    if (!end || (common && (end->at != common->at || end->radius != common->radius))) return {};
    common = end;
  }
  return common;
}

}  // namespace

NearestSegments::NearestSegments(const Kernel& kernel, const Ball& ball)
    : ball_(ball), support_(kernel.family == KernelFamily::Compact ? kernel.shape * (1 + slack) : Box3::inf) {}

std::span<const SeenSegment> NearestSegments::of(std::span<const SegmentSkeleton> strand) {
  seen_.clear();
  double bound = support_;
  for (std::size_t i = 0; i < strand.size(); ++i) {
    const SeenSegment s = seen_from(ball_, strand[i], i);
    if (s.scaled.lo > bound) continue;
    bound = std::min(bound, s.scaled.hi);
    seen_.push_back(s);
  }
  std::erase_if(seen_, [&](const SeenSegment& s) { return s.scaled.lo > bound; });
  if (seen_.size() < 2) return seen_;
  const SegmentPlace nearest =
      std::ranges::min_element(seen_, {}, [](const SeenSegment& s) { return s.place.scaled_squared(); })->place;
  std::erase_if(seen_, [&](const SeenSegment& s) { return is_behind(strand[s.index], nearest, ball_); });
  return seen_;
}

DistancesInReach distances_in_reach(const PrimitiveList<SegmentSkeleton>& list, const Kernel& kernel,
                                    const Ball& ball) {
  DistancesInReach reach;
  NearestSegments nearest(kernel, ball);
  std::vector<SegmentSkeleton> near;
  for_each_strand(list, [&](std::size_t first, std::span<const SegmentSkeleton> strand) {
    near.clear();
    for (const SeenSegment& s : nearest.of(strand)) near.push_back(strand[s.index]);
    if (const auto end = only_end(near, ball)) {
      reach.ends.push_back(*end);
      return;
    }
    reach.segments.skeletons.insert(reach.segments.skeletons.end(), near.begin(), near.end());
    if (!list.strands.empty()) reach.segments.strands.resize(reach.segments.size(), list.strands[first]);
  });
  return reach;
}

}  // namespace marrow
