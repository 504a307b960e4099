// Evaluates each primitive of a blend once; internal to blend/.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "field/blend/blend_field.h"
#include "field/skeleton/skeletons.h"

namespace marrow {

/// Calls visit(first, strand) for each strand of a list, a span of its skeletons, with the index where it begins.
template <class Skeleton, class Visit>
void for_each_strand(const PrimitiveList<Skeleton>& list, const Visit& visit) {
  const std::span<const Skeleton> all = list.skeletons;
  for (std::size_t first = 0, end = 0; first < list.size(); first = end) {
    end = first + 1;
    while (end < list.size() && !list.strands.empty() && list.strands[end] == list.strands[first]) ++end;
    visit(first, all.subspan(first, end - first));
  }
}

/// Calls visit(sample, list, i) for each item of a list, where a strand of a distance list is one item: i is the one
/// with the largest value.
template <class Skeleton, class Field, class Visit>
void visit_strands(const PrimitiveList<Skeleton>& list, const Field& field, const Visit& visit) {
  for_each_strand(list, [&](std::size_t first, std::span<const Skeleton> strand) {
    SkeletonSample largest = field(strand.front());
    std::size_t at = first;
    for (std::size_t i = 1; i < strand.size(); ++i) {
      const SkeletonSample other = field(strand[i]);
      if (!(other.value > largest.value)) continue;
      largest = other;
      at = first + i;
    }
    visit(largest, list, at);
  });
}

/// Whether a list of this blend has the distance model.
template <class List>
bool is_by_distance(const BlendField& blend, const List& list) {
  const void* const at = &list;
  return at == &blend.distance_segments || at == &blend.distance_triangles || at == &blend.distance_arcs;
}

/// Calls visit(sample, list, i) for each primitive.
template <Derivatives Order, class Visit>
void for_each_primitive(const BlendField& blend, const Vec3d& p, const Visit& visit) {
  const int n = blend.degree;
  const auto all = [&](const auto& list, const auto& field) {
    for (std::size_t i = 0; i < list.size(); ++i) visit(field(list.skeletons[i]), list, i);
  };
  const Kernel kernel = kernel_of(blend);
  if (blend.kernel == KernelFamily::Inverse) {
    all(blend.points, [&](const PointSkeleton& s) { return point_field<Order>(s, p, n); });
    all(blend.segments, [&](const SegmentSkeleton& s) { return segment_field<Order>(s, p, n); });
    visit_strands(
        blend.distance_segments, [&](const SegmentSkeleton& s) { return distance_segment_field<Order>(s, p, n); },
        visit);
    all(blend.cani_hornus_segments, [&](const SegmentSkeleton& s) { return cani_hornus_field<Order>(s, p); });
    all(blend.triangles, [&](const TriangleSkeleton& s) { return triangle_field<Order>(s, p, n); });
    all(blend.arcs, [&](const ArcSkeleton& s) { return arc_field<Order>(s, p, n); });
  } else {
    all(blend.points, [&](const PointSkeleton& s) { return point_field<Order>(s, p, kernel); });
    all(blend.segments, [&](const SegmentSkeleton& s) { return segment_field<Order>(s, p, kernel); });
    visit_strands(
        blend.distance_segments, [&](const SegmentSkeleton& s) { return distance_field<Order>(s, p, kernel); }, visit);
    all(blend.triangles, [&](const TriangleSkeleton& s) { return triangle_field<Order>(s, p, kernel); });
    all(blend.arcs, [&](const ArcSkeleton& s) { return arc_field<Order>(s, p, kernel); });
  }
  all(blend.distance_triangles, [&](const TriangleSkeleton& s) { return distance_field<Order>(s, p, kernel); });
  all(blend.distance_arcs, [&](const ArcSkeleton& s) { return distance_field<Order>(s, p, kernel); });
}

/// Calls visit(part, list, i) for each primitive, with what SumBounds::parts() has of it. Each segment of a strand by
/// distance is one.
template <class Parts, class Visit>
void visit_parts(const BlendField& blend, const Parts& parts, const Visit& visit) {
  auto part = parts.begin();
  const auto all = [&](const auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i, ++part) visit(*part, list, i);
  };
  all(blend.points);
  all(blend.segments);
  all(blend.triangles);
  all(blend.arcs);
  all(blend.cani_hornus_segments);
  all(blend.distance_segments);
  all(blend.distance_triangles);
  all(blend.distance_arcs);
}

}  // namespace marrow
