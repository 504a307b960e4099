#include "field/blend/bounds/sum/distance_slopes.h"

#include <algorithm>
#include <cmath>

#include "field/blend/bounds/sum/nearest_places.h"
#include "field/skeleton/corners.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

using namespace nearest_places;

// As nearest_of() in distance_field.cpp: the place stands at t = foot + slope h^2 / radius_f along the line, which
// moves by grad t = u + slope (2 across - slope h^2 / radius_f u) / radius_f. Where the radius at the foot vanishes, or
// is below 0 behind the apex of a steep cone, the larger end is nearest: a place on the segment has a radius_f of at
// least |slope| h^2 over the way from the foot to that end. Nothing is known on the axis there.
bool add_places(const SegmentSkeleton& s, const Box3& box, Places& places) {
  const double length = marrow::length(s.to - s.from), slope = (s.radius_to - s.radius_from) / length;
  if (!(length > 0)) return false;
  const Vec3d u = (s.to - s.from) / length;
  const Span from_start = span_of(box, s.from);
  const Interval foot = along(from_start, u);
  const Span across = from_start - times(u, foot);
  const Interval h_squared = squared_length(across);
  Interval foot_radius = s.radius_from + slope * foot;
  const bool may_be_behind = !(foot_radius.lo > 0);
  const Place start{from_start, s.radius_from, identity, true}, end{span_of(box, s.to), s.radius_to, identity, true};
  if (may_be_behind) {
    const Interval to_larger = slope > 0 ? length - foot : foot;
    const double least = std::fabs(slope) * h_squared.lo / to_larger.hi * (1 - 1e-9);
    if (!(least > 0 && to_larger.hi > 0)) return false;
    if (foot_radius.hi < least) {
      places.add(slope > 0 ? end : start);
      return true;
    }
    foot_radius.lo = least;
  }
  const Interval lean = slope * h_squared / foot_radius, t = foot + lean;
  const double slack = 1e-12 * length;
  const bool may_be_start = t.lo < slack || (may_be_behind && slope < 0);
  const bool may_be_end = t.hi > length - slack || (may_be_behind && slope > 0);
  if (t.hi > -slack && t.lo < length + slack) {
    const Interval on_segment{-slack, length + slack}, leans = clamped(lean, on_segment - foot);
    Place inside{across - times(u, leans), s.radius_from + slope * clamped(t, on_segment), identity,
                 !may_be_start && !may_be_end};
    const Span moves = times(u, 1 - slope * leans / foot_radius) + across * (2 * slope / foot_radius);
    const Interval wider = slope / inside.radius;
    for (std::size_t i = 0; i < 3; ++i) inside.turns[i] -= moves * (u[i] + wider * inside.to_point[i]);
    places.add(inside);
  }
  if (may_be_start) places.add(start);
  if (may_be_end) places.add(end);
  return true;
}

// In the plane of a triangle: q = foot + rise height^2 / radius_f, as along a segment: a place in the triangle has a
// radius_f of at least |rise|^2 height^2 over the way from the foot, along the rise, to the corner farthest that way.
// Nothing where the place has no bounds.
struct InPlane {
  Place place;
  bool may_be_inside;
};
std::optional<InPlane> place_in_plane(const TriangleSkeleton& s, const Box3& box) {
  const Corners corners(s);
  const auto& dual = corners.dual;
  const Vec3d rise = corners.gradient_of(s.radii);
  const Vec3d n = corners.normal / std::sqrt(corners.area2);
  const Span from_corner = span_of(box, s.vertices[0]);
  const Interval height = along(from_corner, n), height_squared = square(height);
  const Span over = times(n, height), foot = from_corner - over;
  Interval foot_radius = s.radii[0] + along(foot, rise);
  const bool may_be_behind = !(foot_radius.lo > 0);
  const double steep = length_squared(rise), to_largest = largest_radius(s) - foot_radius.lo;  // the way times |rise|
  if (may_be_behind) {
    const double least = steep * height_squared.lo / to_largest * (1 - 1e-9);
    if (foot_radius.hi < least) return InPlane{{}, false};
    if (!(least > 0)) return {};
    foot_radius.lo = least;
  }
  Interval lean = height_squared / foot_radius;
  if (may_be_behind) lean.hi = std::min(lean.hi, to_largest / steep * (1 + 1e-9));
  const Span beside = times(rise, lean), q = foot + beside;
  const Interval first = along(q, dual[0]), second = along(q, dual[1]), both = first + second;
  constexpr double slack = 1e-12;
  const bool is_inside = !may_be_behind && first.lo > slack && second.lo > slack && both.hi < 1 - slack;
  const bool may_be_inside = first.hi > -slack && second.hi > -slack && both.lo < 1 + slack;
  const Interval radii{least_radius(s) * (1 - slack), largest_radius(s) * (1 + slack)};
  InPlane in{{over - beside, clamped(s.radii[0] + along(q, rise), radii), {}, is_inside}, may_be_inside};
  // foot and radius_f do not move with the height, beside does: by the chain rule; rise lies in the plane
  const Span moves = times(n, 2 * height / foot_radius) - times(rise, lean / foot_radius);
  const Span widens = times(rise, 1) + moves * Interval(steep);
  for (std::size_t i = 0; i < 3; ++i)
    in.place.turns[i] = times(n, n[i]) - moves * Interval(rise[i]) - widens * (in.place.to_point[i] / in.place.radius);
  return in;
}

}  // namespace

std::optional<PrimitiveSlopes> distance_slopes(const SegmentSkeleton& s, const Box3& box, const Kernel& kernel) {
  Places places;
  return add_places(s, box, places) ? places.slopes(kernel) : std::nullopt;
}

std::optional<PrimitiveSlopes> distance_slopes(const TriangleSkeleton& s, const Box3& box, const Kernel& kernel) {
  const auto plane = place_in_plane(s, box);
  if (!plane) return {};
  Places places;
  if (plane->may_be_inside) places.add(plane->place);
  for (std::size_t i = 0; i < 3 && !(plane->may_be_inside && plane->place.is_real); ++i) {
    const std::size_t j = (i + 1) % 3;
    if (!add_places({s.vertices[i], s.vertices[j], s.radii[i], s.radii[j]}, box, places)) return {};
  }
  return places.slopes(kernel);
}

}  // namespace marrow
