#include "field/blend/mean_angles.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <vector>

#include "field/blend/gather.h"
#include "field/blend/log_weight.h"
#include "field/blend/primitive_visit.h"
#include "field/blend/strand_angles.h"
#include "field/skeleton/shares.h"

namespace marrow {
namespace {

// What counts is farther than this from where doubles end, so that what is 0 in doubles does not.
constexpr double vanishing = 1e-100;

bool are_integrals(const BlendField& blend) {
  return blend.kernel != KernelFamily::Compact && blend.distance_segments.empty() && blend.distance_triangles.empty() &&
         blend.distance_arcs.empty() && blend.cani_hornus_segments.empty();
}

// From the middle to anywhere in the box, or on the stretch.
AngleBounds around(const AlphaSample& middle, const MeanChange& change, const Interval& range, const SumBounds& sum) {
  const double most = change.slope, rho = sum.rho(), off = middle_is_off * most;
  AngleBounds bounds;
  for (std::size_t k = 0; k < 3; ++k) {
    const double by = change.bend * rho + off;
    bounds.gradient[k] = clamped({middle.gradient[k] - by, middle.gradient[k] + by}, {-most, most});
  }
  double first = length(middle.gradient) * rho;
  if (const Stretch* way = sum.stretch())
    first = std::min(first, std::fabs(dot(middle.gradient, way->half)) + length(middle.gradient) * way->slack);
  const double bent = (0.5 * change.bend * rho + off) * rho;
  const double by = std::min(first * (1 + middle_is_off) + bent, most * rho) + 1e-12;
  bounds.value = clamped({middle.value - by, middle.value + by}, range);
  return bounds;
}

// Of the logarithm of the sum, in the middle.
Vec3d sum_slope(const std::vector<SumBounds::Integral>& integrals) {
  Vec3d slope{};
  double f = 0;
  for (const SumBounds::Integral& integral : integrals) {
    slope += integral.sample.gradient;
    f += integral.sample.value;
  }
  return slope / f;
}

Interval angles_along(const auto& list, std::size_t i) {
  Interval all(list.alphas[i]);
  if (!list.alphas_to.empty()) all = hull(all, list.alphas_to[i]);
  if (!list.alphas_third.empty()) all = hull(all, list.alphas_third[i]);
  return all;
}

// alpha = sum f_i a_i / sum f_i, where a_i may be a mean over the skeleton.
std::optional<AngleBounds> by_skeletons(const BlendField& blend, const SumBounds& sum) {
  const AlphaSample middle = alpha_of(blend, sum.center(), sum.integrals());
  const Vec3d common = sum_slope(sum.integrals());
  std::vector<MeanTerm> terms;
  terms.reserve(sum.integrals().size());
  Interval range(middle.value);
  bool known = true;
  visit_integrals(blend, sum.integrals(), [&](const auto& integral, const auto& list, std::size_t i) {
    const auto weight = weight_of(integral, sum.rho());
    known = known && weight;
    if (!known || !(weight->log.value > 0)) return;
    const Interval angles = angles_along(list, i);
    range = hull(range, angles);
    MeanTerm term = weight->log.term(common, sum.rho());
    term.apart = std::max(std::fabs(angles.lo - middle.value), std::fabs(angles.hi - middle.value)) + middle_is_off;
    const MeanChange within = weight->mean_of(angles.width());
    term.value_slope = within.slope;
    term.value_bend = within.bend;
    terms.push_back(term);
  });
  if (!known) return {};
  return around(middle, mean_change(terms, range.width(), sum.rho()), range, sum);
}

// Points and triangles have no direction.
template <class Skeleton>
SkeletonDirection direction_of(const BlendField& blend, const Skeleton& skeleton, const IntegralWeight& weight,
                               const Vec3d& p) {
  if constexpr (std::same_as<Skeleton, SegmentSkeleton>) {
    return {.mean = normalize(skeleton.to - skeleton.from).vec()};
  } else if constexpr (std::same_as<Skeleton, ArcSkeleton>) {
    if (!(weight.log.value > 0)) return {};
    const DirectionSample d = arc_direction(skeleton, p, {blend.kernel, blend.degree, blend.kernel_shape});
    return {.mean = d.value / weight.log.value, .turn = weight.mean_of(2)};
  } else {
    return {};
  }
}

Interval direction_range(const BlendField& blend) {
  Interval all(blend.direction_bounds.front().least);
  for (const DirectionBounds& b : blend.direction_bounds) all = hull(hull(all, b.least), b.most);
  return all;
}

std::optional<AngleBounds> by_directions(const BlendField& blend, const SumBounds& sum) {
  std::vector<StrandTerms> strands(blend.direction_bounds.size());
  bool known = true;
  double total = 0;
  visit_integrals(blend, sum.integrals(), [&](const auto& integral, const auto& list, std::size_t i) {
    const auto weight = weight_of(integral, sum.rho());
    known = known && weight;
    if (!known) return;
    strands[list.strands[i]].add(weight->log, direction_of(blend, list.skeletons[i], *weight, sum.center()));
    total += weight->log.value;
  });
  if (!known) return {};
  std::vector<StrandBounds> ordered;
  for (std::size_t i = 0; i < strands.size(); ++i)
    if (strands[i].weight() > 0) ordered.push_back(StrandBounds::of(strands[i], blend.direction_bounds[i], sum.rho()));
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const StrandBounds& a, const StrandBounds& b) { return a.weight.value > b.weight.value; });
  // Of one strand alone the angle is that of parallel ones.
  if (ordered.size() < 2 || !(ordered[1].weight.value > vanishing * total)) return {};
  const Interval range = direction_range(blend);
  const AlphaSample middle = alpha_of(blend, sum.center(), sum.integrals());
  return around(middle, angle_change(ordered, middle.value, range.width(), sum.rho()), range, sum);
}

}  // namespace

std::optional<AngleBounds> mean_angles(const BlendField& blend, const SumBounds& sum) {
  const Interval f = sum.f();
  if (!are_integrals(blend) || sum.unbounded() || !(f.lo > vanishing && f.hi < 0.9 * field_ceiling)) return {};
  return blend.alpha_per_skeleton ? by_skeletons(blend, sum) : by_directions(blend, sum);
}

}  // namespace marrow
