// Second derivatives of fields of the smallest scaled distance: the nearest place as a number with derivatives.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "field/kernel/profile.h"
#include "field/math/elementary.h"
#include "field/skeleton/corners.h"
#include "field/skeleton/implicit_root.h"
#include "field/skeleton/nearest_place.h"
#include "field/skeleton/second_order.h"

namespace marrow {
namespace {

using X = HessianJet;

// v leads from the place to p.
struct Place {
  Vec3<X> v;
  X radius;
  SecondOrderShares shares{};  // not weighted

  X scaled_squared() const { return (square(v.x) + square(v.y) + square(v.z)) / square(radius); }
};

// f = k(y), grad_S f = 2 k'(y) v / tau.
SecondOrderSample sample_at(const Place& q, const Kernel& kernel) {
  const X y = q.scaled_squared();
  if (kernel.family == KernelFamily::Inverse && !(y.value > 0)) return SecondOrderSample::on_skeleton();
  const Profile profile(kernel, 0);
  const auto [value, slope, curvature] = profile.at(y.value);
  const double scale = 1 / profile.normalisation();
  SecondOrderSample s;
  s.field = X::chain(y, value * scale, slope * scale, curvature * scale);
  if (!(s.field.value <= field_ceiling)) return SecondOrderSample::on_skeleton();
  const X fall = X::chain(y, slope * scale, curvature * scale, profile.third(y.value) * scale) * 2.0 / q.radius;
  s.si = {fall * q.v.x, fall * q.v.y, fall * q.v.z};
  return s;
}

Place fixed(const NearestPlace& q) {
  return {variables_at<HessianJet>(q.to_point), X(q.radius), {X(q.shares[0].value), X(q.shares[1].value)}};
}

// Where foot + slope height^2 / (radius at the foot) lies.   [segment_place.h]
Place moving_on(const SegmentSkeleton& s, const Vec3<X>& p) {
  const double length = marrow::length(s.to - s.from), slope = (s.radius_to - s.radius_from) / length;
  const Vec3d u = (s.to - s.from) / length;
  const Vec3<X> from_start = p - s.from;
  const X foot = dot(from_start, u), foot_radius = s.radius_from + slope * foot;
  const Vec3<X> across = from_start - constant<X>(u) * foot;
  const X ahead = slope * (square(across.x) + square(across.y) + square(across.z)) / foot_radius;
  return {across - constant<X>(u) * ahead, foot_radius + slope * ahead, {(foot + ahead) * (1 / length), X()}};
}

Place place_on(const SegmentSkeleton& s, const Vec3d& p) {
  const NearestPlace q = nearest_place(s, p);
  return q.is_fixed() ? fixed(q) : moving_on(s, variables_at<HessianJet>(p));
}

// The same in the plane of a triangle; nothing when it is not inside.
std::optional<Place> place_in_plane(const TriangleSkeleton& s, const Vec3<X>& p) {
  const Corners corners(s);
  const auto& [normal, area2, dual] = corners;
  const Vec3d rise = corners.gradient_of(s.radii);
  const Vec3<X> from = p - s.vertices[0];
  const X over = dot(from, normal);
  const Vec3<X> above = constant<X>(normal / area2) * over, foot = from - above;
  const X foot_radius = s.radii[0] + dot(foot, rise);
  if (!(foot_radius.value > 0)) return {};
  const Vec3<X> beside = constant<X>(rise) * (square(over) * (1 / area2) / foot_radius), q = foot + beside;
  const X first = dot(q, dual[0]), second = dot(q, dual[1]);
  if (!(first.value >= 0 && second.value >= 0 && first.value + second.value <= 1)) return {};
  return Place{above - beside, s.radii[0] + dot(q, rise), {first, second}};
}

Place place_on(const TriangleSkeleton& s, const Vec3d& p) {
  if (const auto inside = place_in_plane(s, variables_at<HessianJet>(p))) return *inside;
  std::optional<Place> best;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    Place edge = place_on(SegmentSkeleton{s.vertices[i], s.vertices[j], s.radii[i], s.radii[j]}, p);
    edge.shares = on_edge<X>(i, j, 1.0 - edge.shares[0], edge.shares[0]);
    if (!best || edge.scaled_squared().value < best->scaled_squared().value) best = edge;
  }
  return *best;
}

// With q(angle) and the radius tau(angle), ln |p - q| - ln tau is stationary: v.q' tau + |v|^2 tau' = 0.
Place place_on(const ArcSkeleton& s, const Vec3d& p) {
  const NearestPlace nearest = nearest_place(s, p);
  if (nearest.is_fixed()) return fixed(nearest);
  const Vec3<X> seen = variables_at<HessianJet>(p - s.center);
  const Vec3d from_center = p - s.center - nearest.to_point;
  const double turn = 2 * std::numbers::pi, span = s.end - s.begin, slope = (s.radius_to - s.radius_from) / span;
  double root = atan2(dot(from_center, s.axis2), dot(from_center, s.axis1));
  root += turn * std::floor((s.begin + nearest.shares[0].value * span - root) / turn + 0.5);
  const auto place_at = [&](const X& angle) {
    const Vec3<X> at = constant<X>(s.axis1 * s.major) * cos(angle) + constant<X>(s.axis2 * s.major) * sin(angle);
    return Place{seen - at, s.radius_from + slope * (angle - s.begin), {(angle - s.begin) * (1 / span), X()}};
  };
  const auto stationary = [&](const X& angle) {
    const Place q = place_at(angle);
    const Vec3<X> along = constant<X>(s.axis2 * s.major) * cos(angle) - constant<X>(s.axis1 * s.major) * sin(angle);
    return dot(q.v, along) * q.radius + dot(q.v, q.v) * slope;
  };
  // its slope by the angle
  const auto [sine, cosine] = sincos(root);
  const Vec3d along = (s.axis2 * cosine - s.axis1 * sine) * s.major, v = nearest.to_point;
  const double radius = s.radius_from + slope * (root - s.begin);
  const double bend = (dot(v, from_center) * -1 - length_squared(along)) * radius - dot(v, along) * slope;
  return place_at(implicit_root(root, bend, stationary));
}

}  // namespace

SecondOrderSample second_order_by_distance(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return s.from == s.to ? SecondOrderSample{} : sample_at(place_on(s, p), kernel);
}
SecondOrderSample second_order_by_distance(const TriangleSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return sample_at(place_on(s, p), kernel);
}
SecondOrderSample second_order_by_distance(const ArcSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return sample_at(place_on(s, p), kernel);
}

SecondOrderShares second_order_nearest_shares(const SegmentSkeleton& s, const Vec3d& p) {
  return place_on(s, p).shares;
}
SecondOrderShares second_order_nearest_shares(const TriangleSkeleton& s, const Vec3d& p) {
  return place_on(s, p).shares;
}
SecondOrderShares second_order_nearest_shares(const ArcSkeleton& s, const Vec3d& p) { return place_on(s, p).shares; }

Vec3<X> second_order_nearest_direction(const ArcSkeleton& s, const Vec3d& p) {
  const Vec3d axis = cross(s.axis1, s.axis2) / s.major;
  return cross(constant<X>(axis), variables_at<HessianJet>(p - s.center) - place_on(s, p).v);
}

}  // namespace marrow
