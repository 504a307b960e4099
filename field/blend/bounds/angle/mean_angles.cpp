#include "field/blend/bounds/angle/mean_angles.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <vector>

#include "field/blend/bounds/angle/field_weight.h"
#include "field/blend/bounds/angle/strand_angles.h"
#include "field/blend/gather.h"
#include "field/blend/primitive_visit.h"
#include "field/skeleton/corners.h"
#include "field/skeleton/shares.h"

namespace marrow {
namespace {

// What counts is farther than this from where doubles end, so that what is 0 in doubles does not.
constexpr double vanishing = 1e-100;

using Parts = std::vector<SumBounds::Part>;

const Vec3<Interval> any_gradient{Interval::everything(), Interval::everything(), Interval::everything()};

// Of ln f in the middle; 0 where not all weights are known by their logarithms.
Vec3d common_slope(const Parts& parts) {
  Vec3d slope{};
  double f = 0;
  for (const SumBounds::Part& part : parts) {
    if (part.distance == 0) return {};
    slope += part.sample.gradient;
    f += part.sample.value;
  }
  return slope / f;
}

Interval angles_along(const auto& list, std::size_t i) {
  Interval all(list.alphas[i]);
  if (!list.alphas_to.empty()) all = hull(all, list.alphas_to[i]);
  if (!list.alphas_third.empty()) all = hull(all, list.alphas_third[i]);
  return all;
}

// How fast the place moves that has all of the field, as a share of the segment: the foot of p, or, where by distance a
// cone has the apex O and the slope k, the place Q of the axis for which p O is square to p Q. With e = |p - Q| /
// radius, its distance from O is |p - O| / sqrt(1 - k^2 e^2), and moves by no more than 1 / (1 - k^2 e^2). From
// k e = 1 on it is the larger end.
double place_slope(const SegmentSkeleton& s, bool by_distance, const Interval& e) {
  const double size = length(s.to - s.from), k = std::fabs(s.radius_to - s.radius_from) / size;
  if (!by_distance || k == 0) return 1 / size;
  if (k * e.lo > 1) return 0;
  return k * e.hi < 1 ? (1 + middle_is_off) / (size * (1 - k * k * e.hi * e.hi)) : Box3::inf;
}

// The same of an angle that is linear over a triangle: along its sides, or in its plane, in which only the way along
// the gradient of the radius counts.
double angle_slope(const PrimitiveList<TriangleSkeleton>& list, std::size_t i, const SumBounds::Part& part) {
  const TriangleSkeleton& s = list.skeletons[i];
  const Corners corners(s);
  const double first = list.alphas[i], second = list.alphas_to.empty() ? first : list.alphas_to[i];
  const double third = list.alphas_third.empty() ? first : list.alphas_third[i];
  const double k = length(corners.gradient_of(s.radii)), e = part.scaled.hi;
  double speed = k * part.scaled.lo > 1 ? 0 : k * e < 1 ? (1 + middle_is_off) / (1 - k * k * e * e) : Box3::inf;
  for (std::size_t from = 0; from < 3; ++from) {
    const std::size_t to = (from + 1) % 3;
    const SegmentSkeleton side{s.vertices[from], s.vertices[to], s.radii[from], s.radii[to]};
    speed = std::max(speed, place_slope(side, true, part.scaled) * length(side.to - side.from));
  }
  return length(corners.gradient_of({first, second, third})) * speed;
}
double angle_slope(const PrimitiveList<ArcSkeleton>& list, std::size_t i, const SumBounds::Part& part) {
  const ArcSkeleton& s = list.skeletons[i];
  return angles_along(list, i).width() * part.place_speed / (s.end - s.begin);
}

// A primitive as a term of alpha = sum f_i a_i / sum f_i: a_i may be a mean over the skeleton, or the angle at one
// place.
template <class Skeleton>
MeanTerm angle_term(const BlendField& blend, const PrimitiveList<Skeleton>& list, std::size_t i,
                    const SumBounds::Part& part, const FieldWeight& weight, const Vec3d& common, const SumBounds& sum) {
  const double width = angles_along(list, i).width();
  const auto with_values = [](MeanTerm term, const MeanChange& values) {
    term.value_slope = values.slope;
    term.value_bend = values.bend;
    return term;
  };
  if (width == 0) return weight.term(common, sum.rho());
  if constexpr (std::same_as<Skeleton, SegmentSkeleton>)
    if (&list != &blend.segments) {
      const double slope = width * place_slope(list.skeletons[i], &list == &blend.distance_segments, part.scaled);
      return with_values(weight.term(common, sum.rho()), {slope, Box3::inf});
    }
  if constexpr (std::same_as<Skeleton, TriangleSkeleton> || std::same_as<Skeleton, ArcSkeleton>)
    if (is_by_distance(blend, list))
      return with_values(weight.term(common, sum.rho()), {angle_slope(list, i, part), Box3::inf});
  if (!weight.log) return term_of_all(part);
  return with_values(weight.term(common, sum.rho()), mean_within(part, width, sum.rho()));
}

AngleBounds by_skeletons(const BlendField& blend, const SumBounds& sum, const Parts& parts) {
  const AlphaSample middle = alpha_of_skeletons(blend, sum.center(), parts);
  const Vec3d common = common_slope(parts);
  std::vector<MeanTerm> terms;
  terms.reserve(parts.size());
  Interval range(middle.value);
  visit_parts(blend, parts, [&](const SumBounds::Part& part, const auto& list, std::size_t i) {
    const FieldWeight weight = weight_of(part, sum.rho());
    if (!weight.log && weight.f.hi == 0) return;
    const Interval angles = angles_along(list, i);
    range = hull(range, angles);
    terms.push_back(angle_term(blend, list, i, part, weight, common, sum));
    terms.back().apart =
        std::max(std::fabs(angles.lo - middle.value), std::fabs(angles.hi - middle.value)) + middle_is_off;
  });
  return angles_around(middle, mean_change(terms, range.width(), sum.rho()), range, sum);
}

// Points and triangles have no direction. `weighted`: the direction times the field in the middle.
template <class Skeleton>
SkeletonDirection direction_of(const BlendField& blend, const PrimitiveList<Skeleton>& list, std::size_t i,
                               const SumBounds::Part& part, const DirectionSample& weighted, const Vec3d& p) {
  const Skeleton& skeleton = list.skeletons[i];
  if constexpr (std::same_as<Skeleton, SegmentSkeleton>) {
    return {.mean = normalize(skeleton.to - skeleton.from).vec()};
  } else if constexpr (std::same_as<Skeleton, ArcSkeleton>) {
    const double f = part.sample.value;
    if (is_by_distance(blend, list))
      return {.mean = nearest_direction(skeleton, p, {.value = 1}).value, .turn = part.place_speed};
    if (!(f > 0)) return {.range = 2};
    return {.mean = weighted.value / f, .range = 2};
  } else {
    return {};
  }
}

Interval direction_range(const BlendField& blend) {
  Interval all(blend.direction_bounds.front().least);
  for (const DirectionBounds& b : blend.direction_bounds) all = hull(hull(all, b.least), b.most);
  return all;
}

Interval skeleton_range(const BlendField& blend) {
  Interval all(blend.alpha);
  blend.for_each_list([&](const auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i) all = hull(all, angles_along(list, i));
  });
  return all;
}

std::optional<AngleBounds> by_directions(const BlendField& blend, const SumBounds& sum, const Parts& parts) {
  std::vector<StrandTerms> strands(blend.direction_bounds.size(), StrandTerms(sum.rho()));
  const std::vector<DirectionSample> directions = directions_of(blend, sum.center(), parts);
  auto direction = directions.begin();
  visit_parts(blend, parts, [&](const SumBounds::Part& part, const auto& list, std::size_t i) {
    strands[list.strands[i]].add(part, direction_of(blend, list, i, part, *direction++, sum.center()));
  });
  std::vector<StrandBounds> ordered;
  double total = 0;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    if (strands[i].empty()) continue;
    ordered.push_back(StrandBounds::of(strands[i], blend.direction_bounds[i]));
    total += ordered.back().weight.value;
  }
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const StrandBounds& a, const StrandBounds& b) { return a.weight.value > b.weight.value; });
  const Interval range = direction_range(blend);
  const AlphaSample middle = alpha_of_directions(blend, parts, directions);
  // Of one strand alone the angle is that of parallel ones, everywhere; which of several is alone may change.
  if (ordered.size() == 1) return angles_around({.value = middle.value}, {}, range, sum);
  if (ordered.empty() || !(ordered[1].weight.value > vanishing * total)) return {};
  return angles_around(middle, angle_change(ordered, middle.value, range.width(), sum.rho()), range, sum);
}

std::optional<AngleBounds> of_parts(const BlendField& blend, const SumBounds& sum, const Parts& parts) {
  return blend.alpha_per_skeleton ? by_skeletons(blend, sum, parts) : by_directions(blend, sum, parts);
}

// The hull over all choices of which segment is the largest of each strand, of which `strand` is the first that has not
// been decided.
bool add_choices(const BlendField& blend, const SumBounds& sum, std::size_t strand, const Parts& parts,
                 std::optional<AngleBounds>& all) {
  if (strand == sum.takeovers().size()) {
    const auto bounds = of_parts(blend, sum, parts);
    if (!bounds) return false;
    if (!all) all = bounds;
    all->value = hull(all->value, bounds->value);
    return true;
  }
  const auto& candidates = sum.takeovers()[strand];
  return std::ranges::all_of(candidates, [&](std::size_t largest) {
    Parts chosen = parts;
    for (const std::size_t other : candidates)
      if (other != largest) chosen[other] = {.steepest = 0, .bent = 0};
    return add_choices(blend, sum, strand + 1, chosen, all);
  });
}

std::optional<AngleBounds> of_choices(const BlendField& blend, const SumBounds& sum) {
  constexpr std::size_t most_choices = 8;
  std::size_t choices = 1;
  for (const auto& candidates : sum.takeovers())
    if ((choices *= candidates.size()) > most_choices) return {};
  std::optional<AngleBounds> all;
  if (!add_choices(blend, sum, 0, sum.parts(), all)) return {};
  all->gradient = any_gradient;
  return all;
}

std::optional<AngleBounds> known_angles(const BlendField& blend, const SumBounds& sum) {
  const Interval f = sum.f();
  if (sum.unbounded()) return {};
  if (!(f.lo > vanishing && f.hi < 0.9 * field_ceiling)) return {};
  return sum.takeovers().empty() ? of_parts(blend, sum, sum.parts()) : of_choices(blend, sum);
}

}  // namespace

AngleBounds mean_angles(const BlendField& blend, const SumBounds& sum) {
  if (const auto known = known_angles(blend, sum)) return *known;
  const Interval range = blend.alpha_per_skeleton ? skeleton_range(blend) : direction_range(blend);
  return {hull(range, blend.alpha), any_gradient};
}

}  // namespace marrow
