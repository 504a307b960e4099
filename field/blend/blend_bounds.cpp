#include "field/blend/blend_bounds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "field/kernel/inverse_family.h"
#include "field/kernel/profile.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;
// Relative error of the closed forms, with a margin of ten.   [field-maths 3.3: 1.2e-13; triangles 2.6e-12]
constexpr double sample_error = 3e-11;

Interval pad(double x, double by) { return {rounding::down(x - by), rounding::up(x + by)}; }

// Bounds of f and of S = grad_S f and their derivatives over a ball of radius rho around p, one primitive after the
// other.
class SumBounds {
 public:
  SumBounds(const Vec3d& p, double rho) : p_(p), rho_(rho) {}

  const Vec3d& center() const { return p_; }
  double rho() const { return rho_; }

  // A primitive that is a positive sum of |p - q|^-m with all q at least `distance` away from the centre and radii up
  // to `radius`. Its k-th derivatives are at most m (m+1) ... (m+k-1) / distance^k times itself, and within rho of the
  // centre all distances shrink by 1 - rho / distance at most.   [tracing 3.1]
  void add(const SkeletonSample& s, double distance, double radius, int m) {
    const double q = rho_ / distance;
    if (!(q < 0.9) || !std::isfinite(s.value)) return add_near(s, distance, m);
    const double shrink = 1 / (1 - q), grown = integer_power(shrink, m + 2) * s.value / (distance * distance);
    f_ += s.value;
    gradient_ += s.gradient;
    S_ += s.si_gradient;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) J_[i][j] += s.si_jacobian.rows[i][j];
    second_ += m * (m + 1) * grown;
    const double third = m * (m + 1) * (m + 2) * grown * radius;
    S_second_ += third * shrink / distance;
    error_ += sample_error * s.value;
    slope_error_ += sample_error * (m * s.value / distance);
    S_error_ += sample_error * (m * s.value * radius / distance);
  }
  // Anything may happen above what the farthest distances leave.
  void add_near(const SkeletonSample& s, double distance, int m) {
    unbounded_ = true;
    if (std::isfinite(s.value) && distance > 0) low_ += s.value / integer_power(1 + rho_ / distance, m);
  }
  void add_between(const Interval& f, double S_norm) {
    if (!(f.hi < inf) || !(S_norm < inf)) unbounded_ = true;
    else {
      f_ += f.middle();
      error_ += 0.5 * f.width() * (1 + 1e-15) + 1e-15 * f.hi;
      slope_free_ = true;
      S_error_ += S_norm;
    }
    low_ += 0;
  }

  bool unbounded() const { return unbounded_; }
  Interval f(const Box3& box) const {
    Interval x = pad(f_, error_ + 0.5 * second_ * rho_ * rho_);
    for (std::size_t i = 0; i < 3; ++i) x += Interval(gradient_[i]) * side(box, i);
    return {std::max({0.0, x.lo, low_}), std::max(0.0, x.hi)};
  }
  double low() const { return low_ * (1 - 1e-12); }
  Vec3<Interval> gradient() const {
    if (slope_free_) return {Interval::everything(), Interval::everything(), Interval::everything()};
    const double by = second_ * rho_ + slope_error_;
    return {pad(gradient_.x, by), pad(gradient_.y, by), pad(gradient_.z, by)};
  }
  Vec3<Interval> S(const Box3& box) const {
    Vec3<Interval> s;
    const double by = S_error_ + 0.5 * S_second_ * rho_ * rho_;
    for (std::size_t i = 0; i < 3; ++i) {
      s[i] = pad(S_[i], by);
      for (std::size_t j = 0; j < 3; ++j) s[i] += Interval(J_[i][j]) * side(box, j);
    }
    return s;
  }
  // d S_i / d p_j
  Interval J(std::size_t i, std::size_t j) const {
    return slope_free_ ? Interval::everything() : pad(J_[i][j], S_second_ * rho_ + sample_error * std::fabs(J_[i][j]));
  }

 private:
  Interval side(const Box3& box, std::size_t i) const { return Interval(box.lower[i], box.upper[i]) - Interval(p_[i]); }

  Vec3d p_;
  double rho_;
  double f_ = 0, low_ = 0, error_ = 0, slope_error_ = 0, S_error_ = 0, second_ = 0, S_second_ = 0;
  Vec3d gradient_{}, S_{};
  double J_[3][3] = {};
  bool unbounded_ = false, slope_free_ = false;
};

void add_inverse(const BlendField& blend, SumBounds& sum) {
  const int n = blend.degree;
  const Vec3d& p = sum.center();
  constexpr auto all = Derivatives::Second;
  for (const auto& s : blend.points.skeletons) sum.add(point_field<all>(s, p, n), distance_to(s, p), s.radius, n - 1);
  for (const auto& s : blend.segments.skeletons)
    sum.add(segment_field<all>(s, p, n), distance_to(s, p), std::max(s.radius_from, s.radius_to), n);
  for (const auto& s : blend.triangles.skeletons)
    sum.add(triangle_field<all>(s, p, n), distance_to(s, p), std::max({s.radii[0], s.radii[1], s.radii[2]}), n + 1);
  for (const auto& s : blend.arcs.skeletons)
    sum.add(arc_field<all>(s, p, n), distance_to(s, p), std::max(s.radius_from, s.radius_to), n);
  // e = min d / radius changes by rho / radius at most, f = e^-(n-1), |S| = (n-1) e^-n.
  for (const auto& s : blend.distance_segments.skeletons) {
    const double f = distance_segment_field<Derivatives::ScaleInvariant>(s, p, n).value;
    const double e = std::isfinite(f) ? pow(f, -1.0 / (n - 1)) : 0;
    const double by = sum.rho() / std::min(s.radius_from, s.radius_to) + 1e-12 * e;
    const double near = e - by, far = e + by;
    if (near > 0)
      sum.add_between({(1 - 1e-12) / integer_power(far, n - 1), (1 + 1e-12) / integer_power(near, n - 1)},
                      (n - 1) / integer_power(near, n));
    else sum.add_between({0, inf}, inf);
  }
}

// (1 + s^2 d^2 / tau^2)^(-m/2) is an inverse power of the distance in four dimensions, tau / s being the fourth.
void add_cauchy(const BlendField& blend, SumBounds& sum) {
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  const Vec3d& p = sum.center();
  const auto lifted = [&](double distance, double radius) {
    const double w = radius / blend.kernel_shape;
    return std::sqrt(distance * distance + w * w);
  };
  constexpr auto all = Derivatives::Second;
  for (const auto& s : blend.points.skeletons)
    sum.add(point_field<all>(s, p, kernel), lifted(distance_to(s, p), s.radius), s.radius, blend.degree - 1);
  for (const auto& s : blend.segments.skeletons)
    sum.add(segment_field<all>(s, p, kernel), lifted(distance_to(s, p), std::min(s.radius_from, s.radius_to)),
            std::max(s.radius_from, s.radius_to), blend.degree);
}

// f changes by rho sup |k'| times the share of the line that the support can hold.
void add_compact(const BlendField& blend, SumBounds& sum) {
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  const Vec3d& p = sum.center();
  const double R = blend.kernel_shape;
  const auto add = [&](const SkeletonSample& s, double distance, double least, double largest, double length,
                       const Profile& profile) {
    if (distance > sum.rho() + R * largest) return;
    const int m = profile.degree();
    // |k'| = (m x / R^2) (1 - x^2/R^2)^(m/2-1), largest at x^2 = R^2 / (m - 1)
    const double steepest = m / (R * std::sqrt(m - 1.0)) * pow(1 - 1.0 / (m - 1), 0.5 * m - 1);
    const double share = length > 0 ? std::min(length, 2 * R * largest) / least : 1;
    const double per_length = steepest * share / (profile.normalisation() * least) * (1 + 1e-12);
    const double by = per_length * sum.rho() + 1e-11 * s.value;
    sum.add_between({std::max(0.0, s.value - by), s.value + by}, per_length * largest);
  };
  const Profile of_point(kernel, 0), of_curve(kernel, 1);
  for (const auto& s : blend.points.skeletons)
    add(point_field<Derivatives::ScaleInvariant>(s, p, kernel), distance_to(s, p), s.radius, s.radius, 0, of_point);
  for (const auto& s : blend.segments.skeletons)
    add(segment_field<Derivatives::ScaleInvariant>(s, p, kernel), distance_to(s, p),
        std::min(s.radius_from, s.radius_to), std::max(s.radius_from, s.radius_to), length(s.to - s.from), of_curve);
}

// Slope of the chord of the convex curve g between two of its points; isotone in both.
Interval chord_slope(const ReferenceCurve& curve, const Interval& a, const Interval& b) {
  const auto slope = [&](double x, double y) {
    if (std::fabs(x - y) < 1e-4 * std::max(x, y)) return curve.slope(0.5 * (x + y));
    return (curve.at(x) - curve.at(y)) / (x - y);
  };
  // Near the diagonal the slope in the middle is off by (1e-4)^2 / 24 g'''/g' < 1e-8, farther the difference loses
  // 1e-11.
  return {slope(a.lo, b.lo) * (1 - 1e-8), slope(a.hi, b.hi) * (1 + 1e-8)};
}

struct PartialBounds {
  Interval df, dG;
};

// C is isotone and its clamp makes it no steeper than the curve: dC/df <= 1, dC/dG <= 1/g'(C).   [tracing 3.3]
PartialBounds coarse_partials(const ReferenceCurve& curve, const Interval& value) {
  return {{0, 1}, {0, value.lo > 0 ? rounding::up(1 / curve.slope(value.lo), 8) : inf}};
}

// The partial derivatives of the projection onto the chord.   [field-maths 4.5]
PartialBounds chord_partials(const ReferenceCurve& curve, const Correction& c, const Interval& f, const Interval& x_H) {
  const double sine = sin(c.alpha()), cosine = cos(c.alpha());
  const Interval s = chord_slope(curve, f, x_H), sc = s * Interval(cosine), den = sc + Interval(sine);
  const Interval psi = sc / den, ps = Interval(cosine * sine) / square(den);
  const auto slope = [&](const Interval& x) { return Interval{curve.slope(x.lo), curve.slope(x.hi)}; };
  const Interval df = Interval(1) - psi - ps * (slope(f) - s);
  const Interval dx = psi - ps * (s - slope(x_H));
  return {{std::max(0.0, df.lo), df.hi}, Interval{std::max(0.0, dx.lo), dx.hi} / slope(x_H)};
}

// The root of g(x) cos + x sin = G cos + f sin moves by sin / (g' cos + sin) with f, by cos / (g' cos + sin) with G.
PartialBounds exact_partials(const ReferenceCurve& curve, const Correction& c, const Interval& value) {
  const double sine = sin(c.alpha()), cosine = cos(c.alpha());
  const Interval slope{curve.slope(value.lo) * (1 - 1e-9), curve.slope(value.hi) * (1 + 1e-9)};
  const Interval den = slope * Interval(cosine) + Interval(sine);
  return {Interval(sine) / den, Interval(cosine) / den};
}

// Behind the critical point the corrected value is that of D: only where c = G r^n / (2 (n-1)) < 1 / sqrt(n+1).
bool may_be_behind_critical_point(const Correction& c, const Interval& f, const Interval& G) {
  if (!c.cavity() || !(f.hi > 0)) return c.cavity();
  const int n = c.degree();
  const double r = pow(2 / f.hi, 1.0 / (n - 1));
  return G.lo * integer_power(r, n) / (2 * (n - 1)) < (1 + 1e-9) / std::sqrt(n + 1.0);
}

PartialBounds partial_bounds(const BlendField& blend, const Correction& c, const Interval& value, const Interval& f,
                             const Interval& G) {
  if (c.is_sum()) return {{1, 1}, {0, 0}};
  if (blend.kernel != KernelFamily::Inverse) return {Interval::everything(), Interval::everything()};
  const ReferenceCurve curve(blend.degree);
  if (!(f.lo > 0 && G.lo > 0) || may_be_behind_critical_point(c, f, G))
    return c.cavity() ? coarse_partials(curve, value) : PartialBounds{Interval::everything(), Interval::everything()};
  if (c.projection() == Projection::Exact) return exact_partials(curve, c, value);
  const Interval x_H{curve.inverse(G.lo) * (1 - 1e-12), curve.inverse(G.hi) * (1 + 1e-12)};
  return chord_partials(curve, c, f, x_H);
}

// For alpha >= 0 C is isotone in both.   [tracing 3.3]
// Below 0, where the guard cannot act, it is isotone in G; along f its largest value is at an end, its least at an end
// or on the crest of the curves M_d. Where the guard may act, C lies between 0 and 2 x_H.   [tracing 3.3;
// field-maths 4.4]
Interval corrected(const Correction& c, const Interval& f, const Interval& G) {
  if (c.alpha() >= 0) return {c.value(f.lo, G.lo) * (1 - 1e-12), c.value(f.hi, G.hi) * (1 + 1e-12)};
  const int n = c.degree();
  const ReferenceCurve curve(n);
  const double x_least = curve.inverse(G.lo), tangent = -tan(c.alpha());
  const bool may_be_guarded = chord_slope(curve, Interval(f.lo), Interval(x_least)).lo < 2 * tangent * (1 + 1e-9);
  if (may_be_guarded || !(f.lo > 0)) return {0, 2 * curve.inverse(G.hi) * (1 + 1e-12)};
  const double crest_r = pow(2 * (n - 1) / (std::sqrt(n + 1.0) * G.lo), 1.0 / n);
  const double crest = std::clamp(2 / integer_power(crest_r, n - 1), f.lo, f.hi);
  const double least = std::min({c.value(f.lo, G.lo), c.value(f.hi, G.lo), c.value(crest, G.lo)});
  const double most = std::max(c.value(f.lo, G.hi), c.value(f.hi, G.hi));
  return {least * (1 - 1e-9), most * (1 + 1e-9)};
}

BlendBounds bounds_of_sum(const BlendField& blend, const SumBounds& sum, const Box3& box) {
  const Correction c = correction_of(blend);
  const Vec3<Interval> unknown{Interval::everything(), Interval::everything(), Interval::everything()};
  if (blend.alpha_per_skeleton) return {{0, inf}, unknown};
  if (sum.unbounded() && blend.alpha < 0) return {{0, inf}, unknown};
  if (sum.unbounded()) return {{c.value(sum.low(), 0) * (1 - 1e-12), inf}, unknown};
  const Interval f = sum.f(box);
  const Vec3<Interval> S = sum.S(box), gradient = sum.gradient();
  const Interval G = sqrt(square(S.x) + square(S.y) + square(S.z));
  BlendBounds b{.value = corrected(c, f, G), .gradient = unknown};
  if (blend.alpha < 0) return b;
  const PartialBounds by = partial_bounds(blend, c, b.value, f, G);
  for (std::size_t j = 0; j < 3; ++j) {
    Interval G_slope;  // d G / d p_j = S . dS/dp_j / G, and |S_i / G| <= 1
    for (std::size_t i = 0; i < 3; ++i) G_slope += clamped(S[i] / G, {-1, 1}) * sum.J(i, j);
    b.gradient[j] = by.df * gradient[j] + by.dG * G_slope;
  }
  return b;
}

}  // namespace

BlendBounds blend_bounds(const BlendField& blend, const Box3& box) {
  const Vec3d p = box.center();
  const double rho = 0.5 * length(box.size()) * (1 + 1e-15);
  if (!is_finite(p) || !std::isfinite(rho))
    return {{0, inf}, {Interval::everything(), Interval::everything(), Interval::everything()}};
  SumBounds sum(p, rho);
  if (blend.kernel == KernelFamily::Inverse) add_inverse(blend, sum);
  if (blend.kernel == KernelFamily::Cauchy) add_cauchy(blend, sum);
  if (blend.kernel == KernelFamily::Compact) add_compact(blend, sum);
  return bounds_of_sum(blend, sum, box);
}

namespace {

// Upper bounds of f and G of all primitives together from a distance on: sums of mass / d^m.
struct Tail {
  double mass, radius;
  int m;
};
std::vector<Tail> tails(const BlendField& blend) {
  const int n = blend.degree;
  const Kernel kernel{blend.kernel, n, blend.kernel_shape};
  const auto scale = [&](int dimension) {
    if (blend.kernel == KernelFamily::Inverse)
      return dimension == 0 ? 1.0 : dimension == 1 ? 1 / curve_normalisation(n) : 1 / surface_normalisation(n);
    // (1 + s^2 x^2)^(-m/2) <= (s x)^-m; the compact kernel is below every power that is 1 at its support
    const Profile profile(kernel, dimension);
    const double s = blend.kernel == KernelFamily::Cauchy ? 1 / blend.kernel_shape : blend.kernel_shape;
    return integer_power(s, kernel_degree(n, dimension)) / profile.normalisation();
  };
  std::vector<Tail> all;
  const auto add = [&](double radius, double measure, int dimension) {
    all.push_back({scale(dimension) * measure * integer_power(radius, n - 1), radius, kernel_degree(n, dimension)});
  };
  for (const auto& s : blend.points.skeletons) add(s.radius, 1, 0);
  for (const auto& s : blend.segments.skeletons) add(std::max(s.radius_from, s.radius_to), length(s.to - s.from), 1);
  for (const auto& s : blend.distance_segments.skeletons) add(std::max(s.radius_from, s.radius_to), 1, 0);
  for (const auto& s : blend.triangles.skeletons)
    add(std::max({s.radii[0], s.radii[1], s.radii[2]}),
        0.5 * length(cross(s.vertices[1] - s.vertices[0], s.vertices[2] - s.vertices[0])), 2);
  for (const auto& s : blend.arcs.skeletons) add(std::max(s.radius_from, s.radius_to), s.major * (s.end - s.begin), 1);
  return all;
}

}  // namespace

Box3 blend_extent(const BlendField& blend, double level) {
  const Box3 skeletons = skeleton_bounds(blend);
  if (skeletons.empty()) return skeletons;
  const std::vector<Tail> all = tails(blend);
  const auto highest = [&](double d) {
    double f = 0, G = 0;
    for (const Tail& t : all) {
      const double x = t.mass / integer_power(d, t.m);
      f += x;
      G += t.m * x * t.radius / d;
    }
    // Below alpha = 0 the guard gives 2 x_H at most.   [field-maths 4.4]
    if (blend.alpha < 0 || blend.alpha_per_skeleton) return f + 2 * ReferenceCurve(blend.degree).inverse(G);
    return correction_of(blend).value(f, G);
  };
  double margin = largest_radius(blend);
  while (!(highest(margin) < level * (1 - 1e-9)) && margin < 1e30) margin *= 1.25;
  return skeletons.padded(margin);
}

}  // namespace marrow
