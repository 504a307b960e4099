#include "field/blend/distance_slopes.h"

#include <algorithm>
#include <cmath>

#include "field/kernel/profile.h"
#include "field/number/jet.h"
#include "field/skeleton/corners.h"

namespace marrow {
namespace {

using X = Jet<Interval, 3>;

Vec3<X> variables_over(const Box3& box) {
  return {X::variable({box.lower.x, box.upper.x}, 0), X::variable({box.lower.y, box.upper.y}, 1),
          X::variable({box.lower.z, box.upper.z}, 2)};
}
Vec3<X> constant(const Vec3d& v) { return {X(v.x), X(v.y), X(v.z)}; }
X along(const Vec3<X>& v, const Vec3d& u) { return v.x * u.x + v.y * u.y + v.z * u.z; }
Vec3<X> times(const Vec3d& u, const X& t) { return {t * u.x, t * u.y, t * u.z}; }

// A place that may be the nearest one, seen from the points of a box.
struct Place {
  Vec3<X> to_point;
  X radius;
  bool is_real;  // for every point a place of the skeleton, though it may not be the nearest one

  Interval scaled_squared() const {
    const auto& [x, y, z] = to_point;
    return (square(x.value) + square(y.value) + square(z.value)) / square(radius.value);
  }
};

// The few places of one skeleton.
class Places {
 public:
  void add(const Place& p) { all_[count_++] = p; }
  // A place is out where another is nearer all over the box.
  std::optional<PrimitiveSlopes> slopes(const Kernel&) const;

 private:
  std::array<Place, 10> all_;
  std::size_t count_ = 0;
};

Interval padded(double a, double b) {
  const Interval x{std::min(a, b), std::max(a, b)};
  return {x.lo - 1e-12 * std::fabs(x.lo), x.hi + 1e-12 * std::fabs(x.hi)};
}

// All derivatives of the kernels by y = e^2 are monotone. As e is stationary at q, grad y = 2 (p - q) / radius^2, and
// S = 2 k'(y) (p - q) / radius.
std::optional<PrimitiveSlopes> slopes_from(const Place& q, const Interval& y, const Profile& profile) {
  const ProfileSample near = profile.at(y.lo), far = profile.at(y.hi);
  if (!std::isfinite(near.curvature)) return {};
  const double scale = 2 / profile.normalisation();
  const Interval slope = padded(near.slope, far.slope) * scale;
  X k(slope);
  const Interval over = Interval(1) / square(q.radius.value), bend = padded(near.curvature, far.curvature) * scale;
  for (std::size_t j = 0; j < 3; ++j) k.slope[j] = bend * (2 * q.to_point[j].value * over);
  const X k_over = k / q.radius;
  PrimitiveSlopes s;
  for (std::size_t i = 0; i < 3; ++i) {
    s.gradient[i] = slope * q.to_point[i].value * over;
    const X S = q.to_point[i] * k_over;
    for (std::size_t j = 0; j < 3; ++j) s.J[i][j] = S.slope[j];
  }
  return s;
}

PrimitiveSlopes hull(const PrimitiveSlopes& a, const PrimitiveSlopes& b) {
  PrimitiveSlopes both;
  for (std::size_t i = 0; i < 3; ++i) {
    both.gradient[i] = hull(a.gradient[i], b.gradient[i]);
    for (std::size_t j = 0; j < 3; ++j) both.J[i][j] = hull(a.J[i][j], b.J[i][j]);
  }
  return both;
}

std::optional<PrimitiveSlopes> Places::slopes(const Kernel& kernel) const {
  const Profile profile(kernel, 0);
  double nearest = rounding::inf;
  for (std::size_t i = 0; i < count_; ++i)
    if (all_[i].is_real) nearest = std::min(nearest, all_[i].scaled_squared().hi);
  std::optional<PrimitiveSlopes> sum;
  for (std::size_t i = 0; i < count_; ++i) {
    const Interval y = all_[i].scaled_squared();
    if (y.lo > nearest) continue;
    if (!(all_[i].radius.value.lo > 0) || (kernel.family == KernelFamily::Inverse && !(y.lo > 0))) return {};
    const auto own = slopes_from(all_[i], y, profile);
    if (!own) return {};
    sum = sum ? hull(*sum, *own) : *own;
  }
  return sum;
}

// As nearest_of() in distance_field.cpp. Where the radius at the foot may vanish the place has no bounds.
bool add_places(const SegmentSkeleton& s, const Vec3<X>& p, Places& places) {
  const double length = marrow::length(s.to - s.from), slope = (s.radius_to - s.radius_from) / length;
  if (!(length > 0)) return false;
  const Vec3d u = (s.to - s.from) / length;
  const Vec3<X> from_start = p - constant(s.from);
  const X foot = along(from_start, u), foot_radius = s.radius_from + slope * foot;
  if (!(foot_radius.value.lo > 0)) return false;
  const Vec3<X> across = from_start - times(u, foot);
  const X ahead = slope * (dot(across, across) / foot_radius), t = foot + ahead;
  const double slack = 1e-12 * length;
  const bool may_be_start = t.value.lo<slack, may_be_end = t.value.hi> length - slack;
  if (t.value.hi > -slack && t.value.lo < length + slack)
    places.add({across - times(u, ahead), s.radius_from + slope * t, !may_be_start && !may_be_end});
  if (may_be_start) places.add({from_start, X(s.radius_from), true});
  if (may_be_end) places.add({p - constant(s.to), X(s.radius_to), true});
  return true;
}

// The place in the plane of the triangle. Nothing where it has no bounds.
struct InPlane {
  Place place;
  bool may_be_inside;
};
std::optional<InPlane> place_in_plane(const TriangleSkeleton& s, const Vec3<X>& p) {
  const Corners corners(s);
  const auto& dual = corners.dual;
  const Vec3d rise = dual[0] * (s.radii[1] - s.radii[0]) + dual[1] * (s.radii[2] - s.radii[0]);
  const Vec3d n = corners.normal / std::sqrt(corners.area2);
  const Vec3<X> from_corner = p - constant(s.vertices[0]);
  const X height = along(from_corner, n);
  const Vec3<X> over = times(n, height), foot = from_corner - over;
  const X foot_radius = s.radii[0] + along(foot, rise);
  if (!(foot_radius.value.lo > 0)) return {};
  const Vec3<X> beside = times(rise, height * height / foot_radius), q = foot + beside;
  const Interval first = along(q, dual[0]).value, second = along(q, dual[1]).value, both = first + second;
  constexpr double slack = 1e-12;
  const bool is_inside = first.lo > slack && second.lo > slack && both.hi < 1 - slack;
  const bool may_be_inside = first.hi > -slack && second.hi > -slack && both.lo < 1 + slack;
  return InPlane{{over - beside, s.radii[0] + along(q, rise), is_inside}, may_be_inside};
}

}  // namespace

std::optional<PrimitiveSlopes> distance_slopes(const SegmentSkeleton& s, const Box3& box, const Kernel& kernel) {
  Places places;
  return add_places(s, variables_over(box), places) ? places.slopes(kernel) : std::nullopt;
}

std::optional<PrimitiveSlopes> distance_slopes(const TriangleSkeleton& s, const Box3& box, const Kernel& kernel) {
  const Vec3<X> p = variables_over(box);
  const auto plane = place_in_plane(s, p);
  if (!plane) return {};
  Places places;
  if (plane->may_be_inside) places.add(plane->place);
  for (std::size_t i = 0; i < 3 && !(plane->may_be_inside && plane->place.is_real); ++i) {
    const std::size_t j = (i + 1) % 3;
    if (!add_places({s.vertices[i], s.vertices[j], s.radii[i], s.radii[j]}, p, places)) return {};
  }
  return places.slopes(kernel);
}

}  // namespace marrow
