// Marches with certified steps through exact fields.
#include "tests/trace/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"
#include "tests/field/distance_to.h"

namespace marrow::test {
namespace {

// Shorter steps than this times the distance to the skeleton are taken uncertified.
constexpr double shortest_step = 1e-6;

// (1-q)^-m - 1 - m q, from above: Lagrange's remainder.
double remainder(int m, double q) { return m * (m + 1) / 2.0 * q * q / integer_power(1 - q, m + 2); }

}  // namespace

// What bounds the field around one point of a ray.
struct Oracle::Local {
  double f, slope;  // along the ray
  Vec3d g, bend;    // grad_S f and its derivative along the ray
  double n_k;       // at least n K
  double distance;
  double alpha;
};

namespace {

// Whatever the weights of its segments: all lie within some angle of the strand's axis.
double least_mean_direction(const BlendField& blend) {
  double least = 1;
  const auto& strands = blend.segments.strands;
  const auto direction = [&](std::size_t i) {
    const SegmentSkeleton& s = blend.segments.skeletons[i];
    return normalize(s.to - s.from).vec();
  };
  for (std::size_t first = 0, end = 0; first < strands.size(); first = end) {
    Vec3d sum;
    for (end = first; end < strands.size() && strands[end] == strands[first]; ++end) sum += direction(end);
    for (std::size_t i = first; i < end; ++i) least = std::min(least, dot(normalize(sum).vec(), direction(i)));
  }
  return std::max(least, 0.01);
}

// Below an angle of 0 C first falls, then rises in f.
bool is_below(const Correction& c, double f_low, double f_high, double g) {
  return c.value(f_high, g) < 1 && (c.alpha() >= 0 || c.value(f_low, g) < 1);
}

}  // namespace

Oracle::Oracle(const BlendField& blend) : blend_(blend), correction_(correction_of(blend)) {
  if (!blend.alpha_varies()) return;
  least_ = 2;
  most_ = -2;
  const auto include = [&](double alpha) {
    least_ = std::min(least_, alpha);
    most_ = std::max(most_, alpha);
  };
  blend.for_each_list([&](const auto& list) {
    for (const auto* alphas : {&list.alphas, &list.alphas_to}) std::ranges::for_each(*alphas, include);
  });
  for (const DirectionBounds& b : blend.direction_bounds) {
    include(b.least);
    include(b.most);
  }
  if (!blend.direction_bounds.empty()) steepness_ = 2 + 32 / least_mean_direction(blend);
}

Correction Oracle::correction_with(double alpha) const {
  return Correction(blend_.degree, alpha, blend_.cavity, blend_.projection);
}

double Oracle::value(const Vec3d& p) const { return corrected_value(blend_, p); }

double Oracle::skeleton_distance(const Vec3d& p) const {
  double d = std::numeric_limits<double>::infinity();
  for (const auto& s : blend_.points.skeletons) d = std::min(d, length(p - s.at));
  for (const auto& s : blend_.segments.skeletons) d = std::min(d, distance_to(s, p));
  return d;
}

double Oracle::displacement(const Vec3d& p) const {
  const BlendSample s = evaluate(blend_, p);
  return std::fabs(s.corrected - 1) / (length(s.corrected_gradient) * skeleton_distance(p));
}

Oracle::Local Oracle::local(const Vec3d& p, const Vec3d& direction) const {
  const SkeletonSample s = sum_of_primitives<Derivatives::Second>(blend_, p);
  const auto& j = s.si_jacobian.rows;
  const double trace = j[0].x + j[1].y + j[2].z;  // m (m-1) K for exponent m: n K <= trace / (n-2) with points
  return {s.value,
          dot(s.gradient, direction),
          s.si_gradient,
          s.si_jacobian.times(direction),
          trace / (blend_.degree - 2) * (1 + 1e-10),
          skeleton_distance(p) * (1 - 1e-12),
          alpha_at(blend_, p).value};
}

double Oracle::corrected(const Local& l) const {
  return blend_.alpha_varies() ? correction_with(l.alpha).value(l.f, length(l.g)) : correction_.value(l.f, length(l.g));
}

// Both bounds are convex in the step, so its ends suffice.
bool Oracle::outside(const Local& l, double step) const {
  const double q = step / l.distance;
  if (!(q < 0.9)) return false;
  const double bend = l.f * remainder(blend_.degree, q), end = l.f + l.slope * step;
  const double high = std::max(l.f, end + bend), low = std::max(0.0, std::min(l.f, end - bend));
  const double g_end = length(l.g + l.bend * step) + l.n_k * l.distance * remainder(blend_.degree + 1, q);
  const double g = std::max(length(l.g), g_end);
  if (blend_.alpha_varies()) {
    // Means whose weights have logarithms no steeper than n / distance move by the range times that at most; products
    // of two weights by twice that, and the mean direction v of a strand, whose eighth power counts, by 2 / |v|.
    const double turn = steepness_ * (most_ - least_) * blend_.degree * step / (l.distance - step);
    return is_below(correction_with(std::max(least_, l.alpha - turn)), low, high, g) &&
           is_below(correction_with(std::min(most_, l.alpha + turn)), low, high, g);
  }
  return is_below(correction_, low, high, g);
}

// `share` of the distance to the skeleton is what the step before could prove: twice that is tried first.
double Oracle::certified_step(const Local& l, double limit, double& share) const {
  double step = std::min({limit, 0.7 * l.distance, 2 * share * l.distance});
  const double shortest = shortest_step * l.distance;
  while (step > shortest && !outside(l, step)) step *= 0.5;
  share = std::max(step / l.distance, shortest_step);
  return std::max(step, shortest);
}

std::optional<double> Oracle::first_root(const Ray& ray) const {
  double t = ray.t_min, before = t, share = 0.35;
  for (;;) {
    const Local here = local(ray.at(t), ray.direction);
    if (corrected(here) >= 1) break;
    if (t >= ray.t_max) return {};
    before = t;
    // Towards the point of a cone steps shrink without end: none is below what doubles can tell.
    const double least = 1e-14 * (t + max_component(abs(ray.origin)));
    t += std::max(least, certified_step(here, ray.t_max - t, share));
    if (t > ray.t_max) t = ray.t_max;
  }
  for (int i = 0; i < 40 && t > before; ++i) {
    const double middle = 0.5 * (before + t);
    (value(ray.at(middle)) >= 1 ? t : before) = middle;
  }
  return t;
}

double Oracle::largest_excess(const Ray& ray, double t0, double t1) const {
  double largest = value(ray.at(t0)) - 1;
  const double scale = skeleton_distance(ray.at(t0));
  for (double step = 1e-7 * scale; t0 + step < t1; step *= 1.2)
    largest = std::max(largest, value(ray.at(t0 + step)) - 1);
  return largest;
}

double Oracle::largest_deficit(const Ray& ray, double t0, double t1) const {
  constexpr int even = 256;
  double largest = 0;
  const auto look = [&](double t) { largest = std::max(largest, 1 - value(ray.at(t))); };
  for (int i = 0; i <= even; ++i) look(t0 + (t1 - t0) * i / even);
  const double first = std::max(1e-7 * skeleton_distance(ray.at(t0)), 1e-12 * (t1 - t0));
  for (double step = first; t0 + step < t1; step *= 1.2) look(t0 + step);
  return largest;
}

}  // namespace marrow::test
