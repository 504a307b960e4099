// Cubics between places of a ray, their remainders, and where places are put.
#include "tests/stress/way_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "field/math/elementary.h"
#include "field/skeleton/skeleton_sample.h"
#include "tests/field/distance_to.h"

namespace marrow::test {
namespace {

// As the steps of the oracle: what is shorter than this times the distance to the skeleton is not looked at.
constexpr double shortest_step = 1e-6;
// Where places lie nearer to each other than this times that distance the oracle takes over.
constexpr double shortest_stretch = 1e-5;
// Then the oracle takes over.
constexpr int most_places = 64, most_pieces = 1000;
// Bounds of places farther apart than this share of both their distances to the skeletons are not worth a look.
constexpr double farthest = 0.7;
// What sums are known to, and a coordinate.
constexpr double sum_rounding = 1e-12, coordinate_rounding = 4e-16;

double distance_to_nearest(const BlendField& blend, const Vec3d& p) {
  double d = std::numeric_limits<double>::infinity();
  for (const auto& s : blend.points.skeletons) d = std::min(d, length(p - s.at));
  for (const auto& s : blend.segments.skeletons) d = std::min(d, distance_to(s, p));
  return d * (1 - 1e-12);
}

// De Casteljau's way to the coefficients on [0, u] and [u, 1].
template <class Value>
std::pair<std::array<Value, 4>, std::array<Value, 4>> split(const std::array<Value, 4>& c, double u) {
  const auto between = [u](const Value& a, const Value& b) { return a * (1 - u) + b * u; };
  const Value a = between(c[0], c[1]), b = between(c[1], c[2]), d = between(c[2], c[3]);
  const Value ab = between(a, b), bd = between(b, d), middle = between(ab, bd);
  return {{c[0], a, ab, middle}, {middle, bd, d, c[3]}};
}

template <class Value>
std::array<Value, 4> bernstein(const Value& at_a, const Value& slope_a, const Value& at_b, const Value& slope_b,
                               double h) {
  return {at_a, at_a + slope_a * (h / 3), at_b - slope_b * (h / 3), at_b};
}

// n (n+1) ... (n+3)
double rising(int n) { return 1.0 * n * (n + 1) * (n + 2) * (n + 3); }

}  // namespace

struct WayProof::Stretch {
  double begin, end;
};

struct WayProof::Effort {
  int places = most_places, pieces = most_pieces;
};

// f and grad_S f on [first, last] of a stretch between two places, which is [0, 1]; they are known to
// remainder u^2 (1 - u)^2 + rounding.
struct WayProof::Cubic {
  std::array<double, 4> f;
  std::array<Vec3d, 4> g;
  double first = 0, last = 1;
  double f_remainder = 0, g_remainder = 0, f_rounding = 0, g_rounding = 0;

  static double weight(double u) { return u * u * ((1 - u) * (1 - u)); }
  double largest_weight() const { return first < 0.5 && last > 0.5 ? 1.0 / 16 : std::max(weight(first), weight(last)); }
  std::pair<Cubic, Cubic> split_at(double u) const {
    std::pair<Cubic, Cubic> parts{*this, *this};
    const double share = (u - first) / (last - first);
    std::tie(parts.first.f, parts.second.f) = split(f, share);
    std::tie(parts.first.g, parts.second.g) = split(g, share);
    parts.first.last = parts.second.first = u;
    return parts;
  }
};

WayProof::WayProof(const BlendField& blend, double level, double other)
    : blend_(blend), table_(correction_of(blend), level), other_(other) {}

Place WayProof::place(const Ray& ray, double t) const {
  const Vec3d p = ray.at(t);
  const SkeletonSample s = sum_of_primitives<Derivatives::Second>(blend_, p);
  const auto& j = s.si_jacobian.rows;
  // The trace is m (m-1) K for sources of exponent m, which is n, and n - 1 of points.
  const double trace = j[0].x + j[1].y + j[2].z;
  return {t,
          s.value,
          dot(s.gradient, ray.direction),
          s.si_gradient,
          s.si_jacobian.times(ray.direction),
          trace / (blend_.degree - 2) * (1 + 1e-10),
          distance_to_nearest(blend_, p)};
}

// For alpha >= 0 the operator grows with f and G; below that it is largest at an end of an interval of f.
bool WayProof::holds_at(Side side, double least_f, double largest_f, double least_G, double largest_G) const {
  if (side == Side::Inside) return table_.is_above(other_, std::max(0.0, least_f), std::max(0.0, least_G));
  return table_.is_below(largest_f, largest_G) &&
         (blend_.alpha >= 0 || table_.is_below(std::max(0.0, least_f), largest_G));
}

bool WayProof::holds_on(Side side, const Cubic& c, Effort& effort) const {
  const double weight = c.largest_weight();
  const double f_error = c.f_remainder * weight + c.f_rounding, g_error = c.g_remainder * weight + c.g_rounding;
  const auto [least, largest] = std::minmax({c.f[0], c.f[1], c.f[2], c.f[3]});
  double least_G = 0, largest_G = 0;
  for (const Vec3d& g : c.g) largest_G = std::max(largest_G, length_squared(g));
  largest_G = std::sqrt(largest_G);
  if (side == Side::Inside) {
    // No shorter than along any one direction.
    const Vec3d middle = c.g[0] + c.g[3];
    const double size = length(middle);
    least_G = largest_G;
    for (const Vec3d& g : c.g) least_G = std::min(least_G, dot(g, middle) / size);
  }
  if (holds_at(side, least - f_error, largest + f_error, least_G - g_error, largest_G + g_error)) return true;
  if (--effort.pieces < 0) return false;
  const double u = 0.5 * (c.first + c.last);
  const auto [before, after] = c.split_at(u);
  // Where not even one place holds, no halves do.
  const double f = after.f[0], G = length(after.g[0]);
  const double f_known = c.f_remainder * Cubic::weight(u) + c.f_rounding;
  const double g_known = c.g_remainder * Cubic::weight(u) + c.g_rounding;
  return holds_at(side, f - f_known, f + f_known, G - g_known, G + g_known) && holds_on(side, before, effort) &&
         holds_on(side, after, effort);
}

bool WayProof::holds_between(Side side, const Ray& ray, const Place& a, const Place& b, Stretch s,
                             Effort& effort) const {
  const int n = blend_.degree;
  const double h = b.t - a.t, share = h / (a.distance + b.distance);
  if (!(share < farthest)) return false;
  const double growth = 1 / std::sqrt(1 - share * share), squared = growth * growth, power = integer_power(growth, n);
  Cubic c{.f = bernstein(a.f, a.slope, b.f, b.slope, h), .g = bernstein(a.g, a.bend, b.g, b.bend, h)};
  const double coordinates = max_component(abs(ray.origin)) + std::fabs(b.t);
  double n_k = 0;
  for (const Place* p : {&a, &b}) {
    const double d = p->distance, step = h / d, fourth = step * step * (step * step);
    c.f_remainder = std::max(c.f_remainder, p->f * fourth);
    c.g_remainder = std::max(c.g_remainder, p->n_k * d * fourth);
    const double moved = sum_rounding + (n + 1) * coordinate_rounding * coordinates / d;
    c.f_rounding = std::max(c.f_rounding, p->f * moved);
    c.g_rounding = std::max(c.g_rounding, p->n_k * d * moved);
    n_k = std::max(n_k, p->n_k);
  }
  // Far away sums cannot grow enough, whatever their slopes.
  if (side == Side::Outside && holds_at(side, 0, std::max(a.f, b.f) * power, 0,
                                        std::max(length(a.g), length(b.g)) + 0.5 * h * (n + 1) * n_k * power * squared))
    return true;
  c.f_remainder *= power * squared * squared * (rising(n) / 24);
  c.g_remainder *= power * squared * squared * growth * (rising(n + 1) / 24);
  c.f_rounding *= power * squared;
  c.g_rounding *= power * squared * growth;
  const double first = (s.begin - a.t) / h, last = (s.end - a.t) / h;
  if (last < 1) c = c.split_at(last).first;
  if (first > 0) c = c.split_at(first).second;
  return holds_on(side, c, effort);
}

bool WayProof::holds(Side side, const Ray& ray, const Place& a, const Place& b, Stretch s, Effort& effort) const {
  if (holds_between(side, ray, a, b, s, effort)) return true;
  const double h = b.t - a.t;
  if (effort.pieces < 0 || --effort.places < 0 || h < shortest_stretch * std::min(a.distance, b.distance)) return false;
  const double share = std::clamp(a.distance / (a.distance + b.distance), 0.05, 0.95);
  const Place middle = place(ray, a.t + h * share);
  if (middle.t >= s.end) return holds(side, ray, a, middle, s, effort);
  if (middle.t <= s.begin) return holds(side, ray, middle, b, s, effort);
  const double G = length(middle.g);
  return holds_at(side, middle.f, middle.f, G, G) && holds(side, ray, a, middle, {s.begin, middle.t}, effort) &&
         holds(side, ray, middle, b, {middle.t, s.end}, effort);
}

bool WayProof::is_outside(const Ray& ray, double begin, double end, const Place* beyond) const {
  if (blend_.alpha_varies()) return false;
  const Place a = place(ray, begin);
  const double G = length(a.g), from = begin + shortest_step * a.distance;
  if (!(from < end) || !holds_at(Side::Outside, a.f, a.f, G, G)) return false;
  Effort effort;
  return holds(Side::Outside, ray, a, beyond ? *beyond : place(ray, end), {from, end}, effort);
}

bool WayProof::is_inside(const Ray& ray, double begin, double end) const {
  if (blend_.alpha_varies() || blend_.alpha < 0 || !(begin < end)) return false;
  Effort effort;
  return holds(Side::Inside, ray, place(ray, begin), place(ray, end), {begin, end}, effort);
}

}  // namespace marrow::test
