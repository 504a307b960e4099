// Branch by branch; the results are strands of their own that share places.
#include "field/skeleton/curve_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "field/skeleton/branches.h"
#include "field/skeleton/subdivision_curve.h"

namespace marrow {
namespace {

void append(SkeletonGraph& graph, const Vec3d& position, double radius, std::int32_t parent) {
  graph.positions.push_back(position);
  graph.radii.push_back(radius);
  graph.parents.push_back(parent);
}

void append(SkeletonGraph& graph, const PolylineSkeleton& line) {
  for (std::size_t i = 0; i < line.points.size(); ++i)
    append(graph, line.points[i], line.radii[i],
           i == 0 ? SkeletonGraph::no_parent : static_cast<std::int32_t>(graph.positions.size()) - 1);
}

// The balls, and what `change` makes of each branch.
template <class Change>
SkeletonGraph changed(const SkeletonGraph& graph, std::span<const std::int32_t> sticking, Change change) {
  const Branches branches = branches_of(graph, sticking);
  SkeletonGraph made;
  for (const std::int32_t node : branches.balls) {
    const auto i = static_cast<std::size_t>(node);
    append(made, graph.positions[i], graph.radii[i], SkeletonGraph::no_parent);
  }
  for (const Branches::Path& path : branches.paths) {
    CurveSkeleton curve;
    for (const std::int32_t node : branches.of(path)) {
      curve.points.push_back(graph.positions[static_cast<std::size_t>(node)]);
      curve.radii.push_back(graph.radii[static_cast<std::size_t>(node)]);
    }
    curve.closed = path.is_closed;
    append(made, change(std::move(curve)));
  }
  return made;
}

// How far joint i is from the segment between joints a and b, in place or in radius.
double error(const PolylineSkeleton& line, std::size_t a, std::size_t i, std::size_t b) {
  const Vec3d along = line.points[b] - line.points[a], to_joint = line.points[i] - line.points[a];
  const double square = length_squared(along);
  const double share = square > 0 ? std::clamp(dot(to_joint, along) / square, 0.0, 1.0) : 0.0;
  const double radius = line.radii[a] + (line.radii[b] - line.radii[a]) * share;
  return std::max(length(to_joint - along * share), std::fabs(line.radii[i] - radius));
}

PolylineSkeleton simplified(const PolylineSkeleton& line, double tolerance) {
  std::vector<bool> stays(line.points.size(), false);
  stays.front() = stays.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> ranges{{0, line.points.size() - 1}};
  while (!ranges.empty()) {
    const auto [a, b] = ranges.back();
    ranges.pop_back();
    double worst = tolerance;
    std::size_t split = a;
    for (std::size_t i = a + 1; i < b; ++i)
      if (const double e = error(line, a, i, b); e > worst) worst = e, split = i;
    if (split == a) continue;
    stays[split] = true;
    ranges.push_back({a, split});
    ranges.push_back({split, b});
  }
  PolylineSkeleton made;
  for (std::size_t i = 0; i < stays.size(); ++i)
    if (stays[i]) made.points.push_back(line.points[i]), made.radii.push_back(line.radii[i]);
  return made;
}

}  // namespace

SkeletonGraph subdivide(const SkeletonGraph& graph, Subdivision subdivision, int levels,
                        std::span<const std::int32_t> sticking) {
  return changed(graph, sticking, [&](CurveSkeleton curve) {
    curve.subdivision = subdivision;
    curve.levels = curve.points.size() > 2 ? levels : 0;  // a straight branch stays one segment
    return subdivide(curve);
  });
}

SkeletonGraph simplify(const SkeletonGraph& graph, double tolerance) {
  return changed(graph, {}, [&](CurveSkeleton curve) {
    curve.levels = 0;
    return simplified(subdivide(curve), tolerance);
  });
}

}  // namespace marrow
