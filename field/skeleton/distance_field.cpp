// Fields of the smallest scaled distance e = min |p - q| / radius(q), for any skeleton and kernel.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "field/kernel/profile.h"
#include "field/skeleton/arc_view.h"
#include "field/skeleton/corners.h"
#include "field/skeleton/nearest_place.h"
#include "field/skeleton/segment_place.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

// The place q, with how its radius and its place along a curve move with p.
struct Nearest : NearestPlace {
  Vec3d radius_gradient{}, along_gradient{};

  double scaled_squared() const { return length_squared(to_point) / (radius * radius); }
};

// f = k(y), y = |v|^2 / tau^2. As e is stationary at q, grad y = 2 v / tau^2; in the Jacobian of
// grad_S f = 2 k'(y) v / tau place and radius move.
template <Derivatives Order>
SkeletonSample sample_at(const Nearest& q, const Kernel& kernel) {
  const Vec3d v = q.to_point;
  const double tau = q.radius;
  if (kernel.family == KernelFamily::Inverse && v == Vec3d{}) return SkeletonSample::on_skeleton();
  const Profile profile(kernel, 0);
  const auto [value, slope, curvature] = profile.at(q.scaled_squared());
  const double k = 2 * slope / profile.normalisation();
  SkeletonSample s;
  s.value = value / profile.normalisation();
  if (!(s.value <= field_ceiling)) return SkeletonSample::on_skeleton();
  if constexpr (Order >= Derivatives::First) s.gradient = v * (k / (tau * tau));
  s.si_gradient = v * (k / tau);
  if constexpr (Order >= Derivatives::Second)
    s.si_jacobian =
        Matrix3::outer(v, v) * (4 * curvature / (profile.normalisation() * tau * tau * tau)) +
        (Matrix3::scaled_identity(1) + q.moves * -1.0 + Matrix3::outer(v, q.radius_gradient) * (-1 / tau)) * (k / tau);
  return s;
}

// Along a curve q(t) with q' and q'' and radius slope, where ln e = ln |p - q| - ln tau is stationary at q:
// dt/dp = (q'/d^2 - 2 (v.q') v/d^4) / (ln e)''.
void let_move(Nearest& q, const Vec3d& first, const Vec3d& second, double radius_slope) {
  const Vec3d v = q.to_point;
  const double d2 = length_squared(v), along = dot(v, first) / d2, fall = radius_slope / q.radius;
  const double bend = (length_squared(first) - dot(v, second)) / d2 - 2 * along * along + fall * fall;
  if (!(bend > 0) || !(d2 > 0)) return;
  const Vec3d t_gradient = (first / d2 - v * (2 * along / d2)) / bend;
  q.moves = Matrix3::outer(first, t_gradient);
  q.radius_gradient = t_gradient * radius_slope;
  q.along_gradient = t_gradient;
}

Nearest nearer(const Nearest& a, const Nearest& b) { return b.scaled_squared() < a.scaled_squared() ? b : a; }

Nearest nearest_of(const SegmentSkeleton& s, const Vec3d& p) {
  const double length = marrow::length(s.to - s.from);
  const Vec3d u = (s.to - s.from) / length;
  const SegmentPlace place = segment_place(s, p, length, u);
  Nearest nearest{{place.to_point, place.radius}};
  nearest.shares[0].value = place.along;
  if (!place.is_inside) return nearest;
  let_move(nearest, u, {}, (s.radius_to - s.radius_from) / length);
  nearest.shares[0].gradient = nearest.along_gradient / length;
  return nearest;
}

// In the plane as along a segment, with the gradient of the radius in place of the slope. `inside` when it is in the
// triangle.
struct PlaneNearest {
  Nearest at;
  bool inside;
};
PlaneNearest nearest_in_plane(const TriangleSkeleton& s, const Vec3d& p) {
  const Corners corners(s);
  const auto& dual = corners.dual;
  const Vec3d rise = corners.gradient_of(s.radii);
  const Vec3d n = corners.normal / std::sqrt(corners.area2), from_corner = p - s.vertices[0];
  const double height = dot(from_corner, n);
  const Vec3d over = n * height, foot = from_corner - over;
  const double foot_radius = s.radii[0] + dot(foot, rise);
  if (!(foot_radius > 0)) return {{}, false};
  const Vec3d beside = rise * (height * height / foot_radius), q = foot + beside;
  const double first = dot(q, dual[0]), second = dot(q, dual[1]);
  if (!(first >= 0 && second >= 0 && first + second <= 1)) return {{}, false};
  Nearest at{{over - beside, s.radii[0] + dot(q, rise)}};
  // q = foot + rise height^2 / tau_f, by the chain rule
  const Vec3d step = n * (2 * height / foot_radius) - rise * (height * height / (foot_radius * foot_radius));
  at.moves = Matrix3::scaled_identity(1) + Matrix3::outer(n, n) * -1.0 + Matrix3::outer(rise, step);
  at.radius_gradient = at.moves.transposed_times(rise);
  at.shares = {ShareSample{first, at.moves.transposed_times(dual[0])},
               ShareSample{second, at.moves.transposed_times(dual[1])}};
  return {at, true};
}

Nearest nearest_of(const TriangleSkeleton& s, const Vec3d& p) {
  if (const auto [at, inside] = nearest_in_plane(s, p); inside) return at;
  Nearest best{{p - s.vertices[0], s.radii[0]}};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    Nearest edge = nearest_of(SegmentSkeleton{s.vertices[i], s.vertices[j], s.radii[i], s.radii[j]}, p);
    const ShareSample share = edge.shares[0];
    edge.shares = on_edge<ShareSample>(i, j, {1 - share.value, share.gradient * -1.0}, share);
    best = nearer(best, edge);
  }
  return best;
}

// An arc as a curve over the angle.
struct ArcCurve {
  ArcView view;
  double radius_begin, radius_slope;

  double radius(double angle) const { return radius_begin + radius_slope * (angle - view.begin); }
  // Of e^2 by the angle, but for a positive factor, and how that changes.
  struct Slope {
    double value, bend;
  };
  Slope slope(double angle) const { return slope(angle, sincos(angle / 2)); }
  Slope slope(double angle, const SinCos& half) const {
    const auto [s, c] = half;
    const double chord = 2 * view.r * view.major * s, d2 = view.gap() + 2 * chord * s, tau = radius(angle);
    return {chord * c * tau - d2 * radius_slope,
            view.r * view.major * (c * c - s * s) * tau - chord * c * radius_slope};
  }
  Nearest at(double angle) const {
    const auto half = sincos(angle / 2);
    Nearest q{{view.from_arc(half), radius(angle)}};
    q.shares[0].value = (angle - view.begin) / (view.end - view.begin);
    return q;
  }
  Nearest moving_at(double angle) const {
    Nearest q = at(angle);
    const auto [sine, cosine] = sincos(angle);
    const Vec3d first = (view.tangential * cosine - view.radial * sine) * view.major;
    const Vec3d second = (view.radial * cosine + view.tangential * sine) * -view.major;
    let_move(q, first, second, radius_slope);
    q.shares[0].gradient = q.along_gradient / (view.end - view.begin);
    return q;
  }
};

// Where the slope turns from falling to rising between low and high: by Newton's steps, and halvings where they leave
// what is left or are slow.
double minimum_between(const ArcCurve& curve, double low, double high) {
  double at = low + (high - low) / 2;
  for (int step = 1;; ++step) {
    const auto [slope, bend] = curve.slope(at);
    (slope < 0 ? low : high) = at;
    const double newton = at - slope / bend, middle = low + (high - low) / 2;
    const bool is_inside = newton > low && newton < high && step % 4 != 0;
    const double next = is_inside ? newton : middle;
    if (!(low < middle && middle < high) || std::fabs(next - at) <= 0x1p-53 * std::fabs(at)) return next;
    at = next;
  }
}

Nearest nearest_of(const ArcSkeleton& s, const Vec3d& p) {
  const ArcView view = view_from(s, p);
  const ArcCurve curve{view, s.radius_from, (s.radius_to - s.radius_from) / (view.end - view.begin)};
  const bool is_closed = s.end - s.begin >= 2 * std::numbers::pi * (1 - 1e-12);
  if (curve.radius_slope == 0 && (is_closed || (view.begin <= 0 && view.end >= 0))) return curve.moving_at(0);
  Nearest best = nearer(curve.at(view.begin), curve.at(view.end));
  if (curve.radius_slope == 0) return best;
  // e^2 is a sine against a parabola and has few minima in a turn; each is wider than a 64th of it but where the radius
  // falls to less than that share, or the minima are level with each other
  constexpr int parts = 64;
  const double step = (view.end - view.begin) / parts;
  const SinCos half_step = sincos(step / 2);  // each half angle is the last one turned by it: some 64 ulp at the end
  SinCos half = sincos(view.begin / 2);
  double low = view.begin;
  bool falls = curve.slope(low, half).value < 0;
  for (int i = 1; i <= parts; ++i) {
    const double high = i == parts ? view.end : view.begin + step * i;
    half = {half.sin * half_step.cos + half.cos * half_step.sin, half.cos * half_step.cos - half.sin * half_step.sin};
    const bool falls_there = curve.slope(high, half).value < 0;
    if (falls && !falls_there) best = nearer(best, curve.moving_at(minimum_between(curve, low, high)));
    low = high;
    falls = falls_there;
  }
  return best;
}

}  // namespace

NearestPlace nearest_place(const SegmentSkeleton& s, const Vec3d& p) { return nearest_of(s, p); }
NearestPlace nearest_place(const TriangleSkeleton& s, const Vec3d& p) { return nearest_of(s, p); }
NearestPlace nearest_place(const ArcSkeleton& s, const Vec3d& p) { return nearest_of(s, p); }

template <Derivatives Order>
SkeletonSample distance_field(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  if (s.from == s.to) return {};
  return sample_at<Order>(nearest_of(s, p), kernel);
}
template <Derivatives Order>
SkeletonSample distance_field(const TriangleSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return sample_at<Order>(nearest_of(s, p), kernel);
}
template <Derivatives Order>
SkeletonSample distance_field(const ArcSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return sample_at<Order>(nearest_of(s, p), kernel);
}

template SkeletonSample distance_field<Derivatives::ScaleInvariant>(const SegmentSkeleton&, const Vec3d&,
                                                                    const Kernel&);
template SkeletonSample distance_field<Derivatives::First>(const SegmentSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample distance_field<Derivatives::Second>(const SegmentSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample distance_field<Derivatives::ScaleInvariant>(const TriangleSkeleton&, const Vec3d&,
                                                                    const Kernel&);
template SkeletonSample distance_field<Derivatives::First>(const TriangleSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample distance_field<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample distance_field<Derivatives::ScaleInvariant>(const ArcSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample distance_field<Derivatives::First>(const ArcSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample distance_field<Derivatives::Second>(const ArcSkeleton&, const Vec3d&, const Kernel&);

}  // namespace marrow
