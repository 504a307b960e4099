#include "field/blend/sum_bounds.h"

#include <algorithm>
#include <cmath>

#include "field/kernel/profile.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;
// Relative error of the closed forms, with a margin of ten.   [field-maths 3.3: 1.2e-13; triangles 2.6e-12]
constexpr double sample_error = 3e-11;
// Of integrals under the compact kernel, over what they could be at most.
constexpr double compact_error = 1e-10;

Interval pad(double x, double by) { return {rounding::down(x - by), rounding::up(x + by)}; }

// What a primitive can hold of its skeleton within a distance, over a radius to the power of its dimension.
double share(const PointSkeleton&, double) { return 1; }
double share(const SegmentSkeleton& s, double reach) {
  return std::min(length(s.to - s.from), 2 * reach) / least_radius(s);
}
double share(const ArcSkeleton& s, double) { return s.major * (s.end - s.begin) / least_radius(s); }
double share(const TriangleSkeleton& s, double reach) {
  const double area = 0.5 * length(cross(s.vertices[1] - s.vertices[0], s.vertices[2] - s.vertices[0]));
  return std::min(area, 3.2 * reach * reach) / (least_radius(s) * least_radius(s));
}

// sup |k'| over the scaled distance of a normalised kernel.
double steepest(const Profile& profile, const Kernel& kernel) {
  const int m = profile.degree();
  if (kernel.family == KernelFamily::Cauchy)  // m s x s (1 + s^2 x^2)^(-m/2-1), largest at s^2 x^2 = 1 / (m + 1)
    return m * kernel.shape / std::sqrt(m + 1.0) * pow(1 + 1.0 / (m + 1), -0.5 * m - 1) / profile.normalisation();
  // (m x / R^2) (1 - x^2/R^2)^(m/2-1), largest at x^2 = R^2 / (m - 1); the slope at the support for m = 2
  const double at_top = m > 2 ? pow(1 - 1.0 / (m - 1), 0.5 * m - 1) / std::sqrt(m - 1.0) : 1;
  return m / kernel.shape * at_top / profile.normalisation();
}

// sup of the second derivatives, over the scaled position, of the normalised compact kernel (1 - x^2/R^2)^h, h = m/2:
// its derivatives along and across are -2h/R^2 (1-y)^(h-1) and that plus 4h(h-1)/R^2 y (1-y)^(h-2), y = x^2/R^2 <= 1.
double most_bent(const Profile& profile, const Kernel& kernel) {
  const double m = profile.degree();
  return m < 4 ? inf : m * (m - 2) / (kernel.shape * kernel.shape) / profile.normalisation() * (1 + 1e-9);
}

// The same times what the support holds of a skeleton. For m = 3 second derivatives are at most 3/R^2 (1-y)^(-1/2), and
// along a segment R^2 r^2 (1-y) is a parabola, so that the integral from root to root is finite: that of
// R r / sqrt(Q), Q = (1 - R^2 r'^2) (L^2 - s^2), is at most pi R r / sqrt(1 - R^2 r'^2).
double held_bend(const Profile& profile, const Kernel& kernel, const auto&, double held) {
  return most_bent(profile, kernel) * held;
}
double held_bend(const Profile& profile, const Kernel& kernel, const SegmentSkeleton& s, double held) {
  if (profile.degree() != 3) return most_bent(profile, kernel) * held;
  const double R = kernel.shape, slope = (s.radius_to - s.radius_from) / length(s.to - s.from);
  const double open = 1 - square(R * slope);
  if (!(open > 0)) return inf;
  const double chord = 3.1415927 * R * largest_radius(s) / (least_radius(s) * std::sqrt(open));
  return 3 / (R * R) / profile.normalisation() * chord * (1 + 1e-9);
}

// How far first derivatives of the kernel change over a scaled step, at most, where m = 3: they are 3/R^2 x sqrt(1-y),
// and roots of numbers that differ by d differ by sqrt(d).
double most_changed(const Profile& profile, const Kernel& kernel, double step) {
  const double R = kernel.shape;
  return profile.degree() != 3 ? inf
                               : 3 / (R * R) / profile.normalisation() * (step + std::sqrt(2 * R * step)) * (1 + 1e-9);
}

}  // namespace

SumBounds::SumBounds(const Box3& box)
    : box_(box), center_(box.center()), rho_(0.5 * length(box.size()) * (1 + 1e-15)) {}

SumBounds::SumBounds(const BlendField& blend, const Box3& box) : SumBounds(box) {
  if (blend.kernel == KernelFamily::Inverse) add_inverse(blend);
  if (blend.kernel == KernelFamily::Cauchy) add_cauchy(blend);
  if (blend.kernel == KernelFamily::Compact) add_compact(blend);
  add_distances(blend);
}

void SumBounds::add(const SkeletonSample& s, double distance, double radius, int m) {
  const double q = rho_ / distance;
  log_slope_ = std::max(log_slope_, q < 1 ? m / (distance - rho_) * (1 + 1e-12) : inf);
  if (!(q < 0.9) || !std::isfinite(s.value)) {
    // Anything may happen above what the farthest distances leave.
    unbounded_ = true;
    if (std::isfinite(s.value) && distance > 0) low_ += s.value / integer_power(1 + q, m) * (1 - 1e-10);
    return;
  }
  const double shrink = 1 / (1 - q), grown = integer_power(shrink, m + 2) * s.value / (distance * distance);
  f_ += s.value;
  low_ += s.value / integer_power(1 + q, m) * (1 - 1e-10);
  gradient_ += s.gradient;
  S_ += s.si_gradient;
  J_ += s.si_jacobian;
  second_ += m * (m + 1) * grown;
  S_second_ += m * (m + 1) * (m + 2) * grown * radius * shrink / distance;
  error_ += sample_error * s.value;
  slope_error_ += sample_error * (m * s.value / distance);
  S_error_ += sample_error * (m * s.value * radius / distance);
}

// To second order, or, in boxes so large that it says less, to first.
void SumBounds::add(const SkeletonSample& s, const Smooth& b) {
  const double longest = b.steepest * b.radius, S_by = b.most_bent * b.radius * rho_ + compact_error * longest;
  log_slope_ = inf;
  low_ += std::max(0.0, s.value * (1 - compact_error) - b.steepest * rho_);
  f_ += s.value;
  error_ += compact_error * s.value;
  if (0.5 * b.most_bent * rho_ < b.steepest) {
    gradient_ += s.gradient;
    second_ += b.most_bent;
    slope_error_ += compact_error * b.steepest;
  } else {
    error_ += b.steepest * rho_;
    slope_error_ += b.steepest;
  }
  if (S_by < longest) S_ += s.si_gradient;
  S_error_ += std::min(longest, S_by) * (1 + 1e-9);
  J_error_ += b.most_bent * b.radius;
}

// Within rho distances shrink by 1 - rho / nearest at most, and B3 and B4 hold with the sums of the sources.
void SumBounds::add(const SourceSums& sources) {
  const SourceSample s = sources.at(center_);
  const int m = sources.exponent();
  const double q = rho_ / s.nearest, f = s.sum.value;
  log_slope_ = std::max(log_slope_, q < 1 ? m / (s.nearest - rho_) * (1 + 1e-12) : inf);
  // one factor for all of them tells little where one is near
  low_ += (q < 0.2 ? f / integer_power(1 + q, m) : sources.least_within(center_, rho_)) * (1 - 1e-10);
  if (!(q < 0.9)) {
    unbounded_ = true;
    return;
  }
  const double shrink = (1 + 1e-12) / (1 - q), grown = integer_power(shrink, m + 2);
  f_ += f;
  gradient_ += s.sum.gradient;
  S_ += s.sum.si_gradient;
  J_ += s.sum.si_jacobian;
  second_ += m * (m + 1) * grown * s.second;
  S_second_ += m * (m + 1) * (m + 2) * grown * shrink * s.third;
  error_ += sample_error * f;
  slope_error_ += sample_error * (m * f / s.nearest);
  S_error_ += sample_error * (m * f * sources.largest_radius() / s.nearest);
}

void SumBounds::add(const Between& b) {
  const Interval& f = b.f;
  log_slope_ = std::max(log_slope_, b.log_slope);
  has_slopes_ = false;
  low_ += std::max(0.0, f.lo);
  if (!(f.hi < inf)) {
    unbounded_ = true;
    return;
  }
  f_ += f.middle();
  error_ += 0.5 * f.width() * (1 + 1e-15) + 1e-15 * f.hi;
  S_ += b.S;
  S_error_ += b.S_by;
}

Interval SumBounds::side(std::size_t i) const { return Interval(box_.lower[i], box_.upper[i]) - Interval(center_[i]); }

Interval SumBounds::f() const {
  if (unbounded_) return {low_ * (1 - 1e-12), inf};
  Interval x = pad(f_, error_ + 0.5 * second_ * rho_ * rho_);
  for (std::size_t i = 0; i < 3; ++i) x += Interval(gradient_[i]) * side(i);
  return {std::max({0.0, x.lo, low_ * (1 - 1e-12)}), std::max(0.0, x.hi)};
}

Vec3<Interval> SumBounds::gradient() const {
  if (!has_slopes_ || unbounded_) return {Interval::everything(), Interval::everything(), Interval::everything()};
  const double by = second_ * rho_ + slope_error_;
  return {pad(gradient_.x, by), pad(gradient_.y, by), pad(gradient_.z, by)};
}

Vec3<Interval> SumBounds::S() const {
  Vec3<Interval> s;
  const double by = S_error_ + 0.5 * S_second_ * rho_ * rho_;
  for (std::size_t i = 0; i < 3; ++i) {
    s[i] = pad(S_[i], by);
    for (std::size_t j = 0; j < 3; ++j) s[i] += Interval(J_.rows[i][j]) * side(j);
  }
  return s;
}

Interval SumBounds::J(std::size_t i, std::size_t j) const {
  if (!has_slopes_ || unbounded_) return Interval::everything();
  return pad(J_.rows[i][j], S_second_ * rho_ + sample_error * std::fabs(J_.rows[i][j]) + J_error_);
}

namespace {

constexpr int dimension(const TriangleSkeleton&) { return 2; }
constexpr int dimension(const auto&) { return 1; }

double farthest(const SegmentSkeleton& s, const Vec3d& p) { return std::max(length(p - s.from), length(p - s.to)); }
double farthest(const ArcSkeleton& s, const Vec3d& p) {
  return length(p - place_at(s, 0.5 * (s.begin + s.end))) + 0.5 * measure(s);
}
double farthest(const TriangleSkeleton& s, const Vec3d& p) {
  return std::max({length(p - s.vertices[0]), length(p - s.vertices[1]), length(p - s.vertices[2])});
}

// Of each part the kernel of the largest distance over the least radius, over the largest radius.
template <class Skeleton>
double least_field(const Skeleton& s, const Profile& profile, const Vec3d& center, double rho, int cuts) {
  if (cuts > 0) {
    double sum = 0;
    for (const Skeleton& part : parts(s)) sum += least_field(part, profile, center, rho, cuts - 1);
    return sum;
  }
  const double radius = largest_radius(s), x = (farthest(s, center) + rho) / least_radius(s);
  const double over_radius = measure(s) / (dimension(s) == 2 ? radius * radius : radius);
  return over_radius * profile.at(x * x).value / profile.normalisation() * (1 - 1e-9);
}

}  // namespace

// Where the box comes near, a sample would tell little, and nothing at all on the skeleton.
template <class Skeleton, class Sample>
void SumBounds::add_integral(const BlendField& blend, const Skeleton& s, double distance, int m, const Sample& sample) {
  if (rho_ < (dimension(s) == 2 ? 0.7 : 0.9) * distance) {
    add(sample(), distance, largest_radius(s), m);
    return;
  }
  unbounded_ = true;
  log_slope_ = inf;
  const Profile profile({blend.kernel, blend.degree, blend.kernel_shape}, dimension(s));
  low_ += least_field(s, profile, center_, rho_, dimension(s) == 2 ? 2 : 3);
}

void SumBounds::add_inverse(const BlendField& blend) {
  const int n = blend.degree;
  const Vec3d& p = center_;
  constexpr auto all = Derivatives::Second;
  for (const auto& s : blend.points.skeletons)
    add(point_field<all>(s, p, n), distance_to(s, p), largest_radius(s), n - 1);
  for (const auto& s : blend.segments.skeletons)
    add_integral(blend, s, distance_to(s, p), n, [&] { return segment_field<all>(s, p, n); });
  for (const auto& s : blend.triangles.skeletons)
    add_integral(blend, s, distance_to(s, p), n + 1, [&] { return triangle_field<all>(s, p, n); });
  for (const auto& s : blend.arcs.skeletons)
    add_integral(blend, s, distance_to(s, p), n, [&] { return arc_field<all>(s, p, n); });
  // R(H)^2 times a positive sum of |p - q|^-3, and H moves no faster than p: R changes by its slope times rho at most.
  for (const auto& s : blend.cani_hornus_segments.skeletons) {
    const SkeletonSample sample = cani_hornus_field<Derivatives::ScaleInvariant>(s, p);
    const double f = sample.value, d = distance_to(s, p);
    if (!(d > rho_) || !std::isfinite(f)) {
      add({.f = {0, inf}, .S_by = inf, .log_slope = inf});
      continue;
    }
    const double slope = std::fabs(s.radius_to - s.radius_from) / length(s.to - s.from), q = rho_ / d;
    const double wider = std::min(1 + slope * rho_ / least_radius(s), largest_radius(s) / least_radius(s)) * (1 + 1e-9);
    const double high = f * wider * wider / integer_power(1 - q, 3);
    // S = R^3 grad I, and |grad^2 I| <= 12 I / d^2
    const double R = largest_radius(s), grown = wider * wider * wider;
    const double by = (grown - 1) * length(sample.si_gradient) +
                      12 * R * grown * f * rho_ / (integer_power(1 - q, 5) * d * d) + sample_error * R * f / d;
    const double longest = 3 * R * high / (d - rho_);
    const bool is_near = !(by < longest);
    add({.f = {f / (wider * wider * integer_power(1 + q, 3)), high},
         .S = is_near ? Vec3d{} : sample.si_gradient,
         .S_by = std::min(longest, by) * (1 + 1e-9),
         .log_slope = (3 / (d - rho_) + 2 * slope / least_radius(s)) * (1 + 1e-9)});
  }
}

// (1 + s^2 d^2 / tau^2)^(-m/2) is an inverse power of the distance in four dimensions, tau / s being the fourth.
void SumBounds::add_cauchy(const BlendField& blend) {
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  const Vec3d& p = center_;
  const auto lifted = [&](const auto& s) {
    const double d = distance_to(s, p), w = least_radius(s) / blend.kernel_shape;
    return std::sqrt(d * d + w * w);
  };
  constexpr auto all = Derivatives::Second;
  const int n = blend.degree;
  for (const auto& s : blend.points.skeletons) add(point_field<all>(s, p, kernel), lifted(s), largest_radius(s), n - 1);
  for (const auto& s : blend.segments.skeletons)
    add_integral(blend, s, lifted(s), n, [&] { return segment_field<all>(s, p, kernel); });
  for (const auto& s : blend.triangles.skeletons)
    add_integral(blend, s, lifted(s), n + 1, [&] { return triangle_field<all>(s, p, kernel); });
  for (const auto& s : blend.arcs.skeletons)
    add_integral(blend, s, lifted(s), n, [&] { return arc_field<all>(s, p, kernel); });
}

// f changes by rho sup |k'| times the share of the skeleton that the support can hold.
void SumBounds::add_compact(const BlendField& blend) {
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  const auto all = [&](const auto& skeletons, int dimension, const auto& field) {
    const Profile profile(kernel, dimension);
    const double steep = steepest(profile, kernel);
    for (const auto& s : skeletons) {
      const double reach = kernel.shape * largest_radius(s);
      if (distance_to(s, center_) > rho_ + reach) continue;
      const SkeletonSample sample = field(s);
      const double held = share(s, reach), least = least_radius(s), largest = largest_radius(s);
      const double per_length = steep * held / least * (1 + 1e-9);
      if (const double bend = held_bend(profile, kernel, s, held); bend < inf) {
        add(sample, Smooth{per_length, bend / (least * least), largest});
        continue;
      }
      const double f = sample.value, by = per_length * rho_ + compact_error * f, longest = per_length * largest;
      const double S_by =
          most_changed(profile, kernel, rho_ / least) * held * (largest / least) + compact_error * longest;
      const bool is_near = !(S_by < longest);
      add({.f = {std::max(0.0, f - by), f + by},
           .S = is_near ? Vec3d{} : sample.si_gradient,
           .S_by = std::min(longest, S_by) * (1 + 1e-9),
           .log_slope = inf});
    }
  };
  constexpr auto value = Derivatives::First;
  const Vec3d& p = center_;
  all(blend.points.skeletons, 0, [&](const PointSkeleton& s) { return point_field<value>(s, p, kernel); });
  all(blend.segments.skeletons, 1, [&](const SegmentSkeleton& s) { return segment_field<value>(s, p, kernel); });
  all(blend.triangles.skeletons, 2, [&](const TriangleSkeleton& s) { return triangle_field<value>(s, p, kernel); });
  all(blend.arcs.skeletons, 1, [&](const ArcSkeleton& s) { return arc_field<value>(s, p, kernel); });
}

namespace {

// How far the unit vector from the nearest point of the skeleton turns over rho: level surfaces of e are those of
// convex bodies, flat, round or conical, and curve no more than a ball of the distance, over the cosine of the cone's
// slope. Not known for arcs, whose nearest point may jump.
double turn(const SegmentSkeleton& s, double distance, double rho) {
  const double slope = (s.radius_to - s.radius_from) / length(s.to - s.from);
  return 2 * rho / (distance - rho) / std::sqrt(std::max(0.0, 1 - slope * slope));
}
double turn(const TriangleSkeleton& s, double distance, double rho) {
  return s.radii[0] == s.radii[1] && s.radii[1] == s.radii[2] ? 2 * rho / (distance - rho) : inf;
}
double turn(const ArcSkeleton&, double, double) { return inf; }

// |k'| where the scaled distance is off by `moved` at most from where the field is f: it rises to the steepest place of
// the kernel and falls from there on. The compact kernel has none beyond its support, where only f = 0 is known.
Interval steepness_near(const Profile& profile, const Kernel& kernel, double f, double moved) {
  const int m = profile.degree();
  const bool is_compact = kernel.family == KernelFamily::Compact;
  const double size = is_compact ? kernel.shape : 1 / kernel.shape;
  // (x / size)^2 from k; a relative 1e-9 of it or of 1 stands for the error of the sample.
  const double ratio = std::min(1.0, f * profile.normalisation());
  const double y = is_compact ? 1 - pow(ratio, 2.0 / m) : ratio > 0 ? pow(ratio, -2.0 / m) - 1 : inf;
  const double near = std::max(0.0, size * std::sqrt(std::max(0.0, y - 1e-9 * (1 + y))) - moved);
  const double far = f > 0 ? size * std::sqrt(y + 1e-9 * (1 + y)) + moved : inf;
  const auto slope = [&](double x) {
    if (!(is_compact ? x < size : x < inf)) return 0.0;
    return std::fabs(2 * x * profile.at(x * x).slope) / profile.normalisation();
  };
  const double top = size / std::sqrt(is_compact ? m - 1.0 : m + 1.0), a = slope(near), b = slope(far);
  const bool has_top = near * (1 - 1e-9) <= top && top <= far * (1 + 1e-9);
  const double most = has_top ? steepest(profile, kernel) : std::max(a, b);
  return {std::min(a, b) * (1 - 1e-9), most * (1 + 1e-9)};
}

// e = min d / radius changes by rho / radius at most, f = k(e), |S| = |k'(e)|.
template <class Skeleton>
SumBounds::Between distance_bounds(const Skeleton& s, const SumBounds& sum, const Kernel& kernel) {
  const SkeletonSample sample = distance_field<Derivatives::ScaleInvariant>(s, sum.center(), kernel);
  const double f = sample.value, moved = sum.rho() / least_radius(s), distance = distance_to(s, sum.center());
  const double turned = distance > sum.rho() ? turn(s, distance, sum.rho()) : inf;
  // S between its least and largest length, turned by as much.
  const auto give_S = [&](SumBounds::Between& b, double S_low, double S_high) {
    b.S_by = S_high;
    if (!(turned < 1 && length(sample.si_gradient) > 0)) return;
    b.S = normalize(sample.si_gradient) * (0.5 * (S_low + S_high));
    b.S_by = (0.5 * (S_high - S_low) + S_high * turned) * (1 + 1e-9);
  };
  if (kernel.family != KernelFamily::Inverse) {
    const Profile profile(kernel, 0);
    const double steep = steepest(profile, kernel) * (1 + 1e-9), by = steep * moved + 1e-10 * f;
    SumBounds::Between b{.f = {std::max(0.0, f - by), f + by},
                         .log_slope = f > by ? steep / (least_radius(s) * (f - by)) : inf};
    const Interval lengths = steepness_near(profile, kernel, f, moved);
    give_S(b, lengths.lo, lengths.hi);
    return b;
  }
  const int n = kernel.degree;
  const double e = std::isfinite(f) ? pow(f, -1.0 / (n - 1)) : 0, by = moved + 1e-10 * e;
  const double near = e - by, far = e + by;
  if (!(near > 0)) return {.f = {(1 - 1e-10) / integer_power(far, n - 1), inf}, .S_by = inf, .log_slope = inf};
  const double S_high = (n - 1) * (1 + 1e-10) / integer_power(near, n);
  SumBounds::Between b{.f = {(1 - 1e-10) / integer_power(far, n - 1), (1 + 1e-10) / integer_power(near, n - 1)},
                       .S_by = S_high,
                       .log_slope = (n - 1) * (1 + 1e-10) / (near * least_radius(s))};
  give_S(b, (n - 1) * (1 - 1e-10) / integer_power(far, n), S_high);
  return b;
}

}  // namespace

void SumBounds::add_distances(const BlendField& blend) {
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  const auto& list = blend.distance_segments;
  for (std::size_t i = 0; i < list.size();) {
    // The largest of a strand counts; where several may be that, S is one of theirs.
    Between all = distance_bounds(list.skeletons[i], *this, kernel);
    const std::size_t first = i++;
    for (; !list.strands.empty() && i < list.size() && list.strands[i] == list.strands[first]; ++i) {
      const Between other = distance_bounds(list.skeletons[i], *this, kernel);
      if (other.f.hi < all.f.lo) continue;
      if (all.f.hi < other.f.lo) {
        all = other;
        continue;
      }
      all = {.f = max(all.f, other.f),
             .S = (all.S + other.S) * 0.5,
             .S_by = 0.5 * length(all.S - other.S) + std::max(all.S_by, other.S_by) * (1 + 1e-15),
             .log_slope = std::max(all.log_slope, other.log_slope)};
    }
    add(all);
  }
  for (const auto& s : blend.distance_triangles.skeletons) add(distance_bounds(s, *this, kernel));
  for (const auto& s : blend.distance_arcs.skeletons) add(distance_bounds(s, *this, kernel));
}

}  // namespace marrow
