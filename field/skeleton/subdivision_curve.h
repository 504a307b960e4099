// Subdivision curves: control polylines refined by a mask, with the radius.
#pragma once

#include <cstddef>

#include "field/description/field_node.h"

namespace marrow {

/// Of one curve, after all levels.
inline constexpr std::size_t max_curve_points = 10'000'000;

/// The control polyline refined `levels` times; 0 levels give it back.   [Cani and Hornus 2001, sec. 3]
///   Chaikin  mask (0, 1/2, 1/2): a joint is replaced by a point a quarter into each of its two edges; the limit is
///            the uniform quadratic B-spline;
///   Cubic    mask (1/4, 1/2, 1/4): the middles of edges, and joints moved an eighth toward each neighbour; the
///            limit is the uniform cubic B-spline.
/// Sticking joints, and both ends, stay where they are and stay sticking. Radii follow the same mask. A closed curve
/// has no ends: it is smoothed all around, and the polyline ends in its first point again. Precondition: validated; as
/// many radii as points, at least two, sticking joints ascending or not, all < points.
PolylineSkeleton subdivide(const CurveSkeleton&);

}  // namespace marrow
