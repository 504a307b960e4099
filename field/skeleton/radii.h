// The least and the largest radius of a skeleton.
#pragma once

#include <algorithm>

#include "field/description/field_node.h"

namespace marrow {

inline double largest_radius(const PointSkeleton& s) { return s.radius; }
inline double largest_radius(const SegmentSkeleton& s) { return std::max(s.radius_from, s.radius_to); }
inline double largest_radius(const ArcSkeleton& s) { return std::max(s.radius_from, s.radius_to); }
inline double largest_radius(const TriangleSkeleton& s) { return std::max({s.radii[0], s.radii[1], s.radii[2]}); }

inline double least_radius(const PointSkeleton& s) { return s.radius; }
inline double least_radius(const SegmentSkeleton& s) { return std::min(s.radius_from, s.radius_to); }
inline double least_radius(const ArcSkeleton& s) { return std::min(s.radius_from, s.radius_to); }
inline double least_radius(const TriangleSkeleton& s) { return std::min({s.radii[0], s.radii[1], s.radii[2]}); }

}  // namespace marrow
