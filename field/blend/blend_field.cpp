// Sums the primitives of a blend and corrects the sum.
#include "field/blend/blend_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "field/blend/angle/local_contact.h"
#include "field/blend/gather.h"
#include "field/blend/primitive_visit.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

bool has_materials(const BlendField& blend) {
  bool any = false;
  blend.for_each_list([&](const auto& list) { any = any || !list.materials.empty(); });
  return any;
}

// The whole circle of an arc.
void include_circle(const ArcSkeleton& s, Box3& box) {
  Vec3d reach;
  for (std::size_t k = 0; k < 3; ++k) reach[k] = s.major * std::sqrt(s.axis1[k] * s.axis1[k] + s.axis2[k] * s.axis2[k]);
  box.include(s.center - reach);
  box.include(s.center + reach);
}

}  // namespace

template <Derivatives Order>
SkeletonSample sum_of_primitives(const BlendField& blend, const Vec3d& p) {
  SkeletonSample sum;
  for_each_primitive<Order>(blend, p, [&](const SkeletonSample& s, const auto&, std::size_t) { sum += s; });
  return sum.value <= field_ceiling ? sum : SkeletonSample::on_skeleton();
}

template SkeletonSample sum_of_primitives<Derivatives::ScaleInvariant>(const BlendField&, const Vec3d&);
template SkeletonSample sum_of_primitives<Derivatives::First>(const BlendField&, const Vec3d&);
template SkeletonSample sum_of_primitives<Derivatives::Second>(const BlendField&, const Vec3d&);

Correction correction_of(const BlendField& blend) { return correction_at(blend, blend.alpha); }

AlphaSample alpha_at(const BlendField& blend, const Vec3d& p) {
  if (!blend.alpha_varies()) return {.value = blend.alpha};
  return gather<Derivatives::First>(blend, p).alpha;
}

// grad C = dC/df grad f + dC/dG grad G + dC/dalpha grad alpha,  grad G = J^T grad_S f / G.
BlendSample evaluate(const BlendField& blend, const Vec3d& p) {
  const auto [sum, alpha] = gather<Derivatives::Second>(blend, p);
  const double G = length(sum.si_gradient);
  const Correction::Partials c = correction_at(blend, alpha.value).partials(sum.value, G);
  BlendSample s{.sum = sum.value,
                .sum_gradient = sum.gradient,
                .si_gradient = sum.si_gradient,
                .si_norm = G,
                .alpha = alpha.value,
                .corrected = c.value,
                .corrected_gradient = sum.gradient * c.df};
  if (c.dG_over_G != 0) s.corrected_gradient += sum.si_jacobian.transposed_times(sum.si_gradient) * c.dG_over_G;
  if (blend.alpha_varies()) s.corrected_gradient += alpha.gradient * c.dalpha;
  return s;
}

double corrected_value(const BlendField& blend, const Vec3d& p) {
  const auto [sum, alpha] = gather<Derivatives::ScaleInvariant>(blend, p);
  return correction_at(blend, alpha.value).value(sum.value, length(sum.si_gradient));
}

namespace {

bool are_equal(const auto& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
}

// Of primitives that have angles; nothing when they differ.
std::optional<double> common_angle(const BlendField& blend) {
  std::vector<double> all;
  blend.for_each_list([&](const auto& list) {
    for (const auto* angles : {&list.alphas, &list.alphas_to, &list.alphas_third})
      all.insert(all.end(), angles->begin(), angles->end());
  });
  return !all.empty() && are_equal(all) ? std::optional(all.front()) : std::nullopt;
}

// Of strands whose angles are the same in all directions; nothing where there are none, or where they differ.
std::optional<double> angle_of_all_bounds(const BlendField& blend) {
  if (blend.direction_bounds.empty()) return {};
  const DirectionBounds& first = blend.direction_bounds.front();
  return first.least == first.most && are_equal(blend.direction_bounds) ? std::optional(first.least) : std::nullopt;
}

// By more than rounding.
bool have_several_radii(const BlendField& blend) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  blend.for_each_list([&](const auto& list) {
    for (const auto& s : list.skeletons) {
      least = std::min(least, mean_radius(s));
      most = std::max(most, mean_radius(s));
    }
  });
  return most > least * (1 + 1e-12);
}

// No point is of the strand of another one, or of segments.
bool points_are_strands(const BlendField& blend) {
  std::vector<bool> taken(blend.direction_bounds.size(), false);
  for (const std::uint32_t strand : blend.segments.strands) taken[strand] = true;
  return std::ranges::none_of(blend.points.strands, [&](std::uint32_t strand) {
    const bool before = taken[strand];
    taken[strand] = true;
    return before;
  });
}

// Below it, of degree 3, the guard bends the curve C = 1 at fields where surfaces are, and tables of a range do not
// follow (trace/curve/README.md).
constexpr double least_of_range = -0.8;

bool all_angles_are_known(const BlendField& blend) {
  const auto is_known = [](double alpha) { return alpha >= least_of_range; };
  bool known = std::ranges::all_of(blend.direction_bounds,
                                   [&](const DirectionBounds& b) { return is_known(b.least) && is_known(b.most); });
  blend.for_each_list([&](const auto& list) {
    known = known && std::ranges::all_of(list.alphas, is_known) && std::ranges::all_of(list.alphas_to, is_known);
  });
  return known;
}

// For a range of angles the tracer of blends has bounds with cavity only, and for angles that each primitive has one
// of. Points are to be strands by themselves.
std::string untraceable_angles(const BlendField& blend) {
  const auto unknown = [](const std::string& what) { return what + " not known to the tracer of blends"; };
  if (!blend.cavity) return unknown("`cavity: false` with an `alpha` that varies is");
  if (single_angle(blend)) return {};
  if (!blend.alpha_per_skeleton && blend.direction_bounds.empty())
    return unknown("an `alpha` that varies other than by skeleton or direction is");
  if (!all_angles_are_known(blend)) return unknown("an `alpha` below -0.8 among several is");
  if (!blend.direction_bounds.empty() && !points_are_strands(blend))
    return unknown("points of the strand of others, or of segments, are");
  return {};
}

// How many radii long a segment is, by the radius at each place.
double length_in_radii(const SegmentSkeleton& s) {
  const double thick = std::max(s.radius_from, s.radius_to), thin = std::min(s.radius_from, s.radius_to);
  const double ratio = thick / std::max(thin, 1e-5 * thick), rise = ratio - 1;
  return length(s.to - s.from) / thick * (rise > 1e-3 ? ratio * log(ratio) / rise : ratio);
}

// The tracer of blends cuts segments into pieces of three radii before any ray comes, 4 us and 350 bytes each: of 2e6
// of them 7 s and 0.7 GB. Where few segments have so many, the other tracer takes each as it is.
bool is_very_long(const BlendField& blend) {
  const auto& segments = blend.segments.skeletons;
  const double too_long = std::max(6e6, 3000 * static_cast<double>(segments.size()));
  double radii = 0;
  for (const SegmentSkeleton& s : segments) radii += length_in_radii(s);
  return radii > too_long;
}

}  // namespace

std::optional<double> single_angle(const BlendField& blend) {
  if (!blend.alpha_varies()) return blend.alpha;
  if (blend.local_contact) {
    const LocalContact& rule = *blend.local_contact;
    const bool adapts = rule.adapts_to_density() || (rule.adapts_to_radii() && have_several_radii(blend));
    return adapts ? std::nullopt : std::optional(rule.contact());
  }
  if (blend.alpha_per_skeleton) return common_angle(blend);
  if (blend.direction_bounds.size() == 1) return blend.direction_bounds.front().most;
  if (const auto angle = angle_of_all_bounds(blend)) return angle;
  const bool points_alone = blend.points.size() == blend.size() && blend.points.size() > 1;
  if (points_alone && blend.direction_bounds.size() > 1 && are_equal(blend.direction_bounds))
    return blend.direction_bounds.front().least;
  return {};
}

std::string untraceable_part(const BlendField& blend) {
  const auto evaluated_only = [](const std::string& what) { return what + " is not known to the tracer of blends"; };
  if (blend.kernel == KernelFamily::Cauchy) return evaluated_only("`kernel: {cauchy: …}`");
  if (blend.kernel == KernelFamily::Compact) return evaluated_only("`kernel: {compact: …}`");
  if (!blend.distance_segments.empty() || !blend.distance_triangles.empty() || !blend.distance_arcs.empty())
    return evaluated_only("`model: distance`");
  if (!blend.cani_hornus_segments.empty()) return evaluated_only("`model: cani_hornus`");
  if (!blend.triangles.empty()) return evaluated_only("`triangle`");
  if (!blend.arcs.empty()) return evaluated_only("`circle` or `arc`");
  if (is_very_long(blend)) return evaluated_only("millions of radii of a few segments");
  return blend.alpha_varies() ? untraceable_angles(blend) : std::string{};
}

MaterialWeights material_weights(const BlendField& blend, const Vec3d& p) {
  MaterialWeights all;
  double sum = 0;
  std::optional<MaterialId> touched;
  for_each_primitive<Derivatives::ScaleInvariant>(blend, p,
                                                  [&](const SkeletonSample& s, const auto& list, std::size_t i) {
                                                    if (!(s.value > 0)) return;
                                                    if (std::isinf(s.value) && !touched) touched = list.material(i);
                                                    sum += s.value;
                                                    add_weight(all, list.material(i), s.value);
                                                  });
  if (touched) return {{*touched, 1}};
  for (MaterialWeight& w : all) w.weight /= sum;
  return all;
}

MaterialId strongest_material(const BlendField& blend, const Vec3d& p) {
  return has_materials(blend) ? strongest(material_weights(blend, p)) : MaterialId{};
}

Box3 skeleton_bounds(const BlendField& blend) {
  Box3 box;
  for (const auto& s : blend.points.skeletons) box.include(s.at);
  for (const auto* list : {&blend.segments, &blend.distance_segments, &blend.cani_hornus_segments})
    for (const auto& s : list->skeletons) {
      box.include(s.from);
      box.include(s.to);
    }
  for (const auto* list : {&blend.triangles, &blend.distance_triangles})
    for (const auto& s : list->skeletons)
      for (const Vec3d& vertex : s.vertices) box.include(vertex);
  for (const auto* list : {&blend.arcs, &blend.distance_arcs})
    for (const auto& s : list->skeletons) include_circle(s, box);
  return box;
}

double largest_radius(const BlendField& blend) {
  double largest = 0;
  for (const auto& s : blend.points.skeletons) largest = std::max(largest, s.radius);
  for (const auto* list : {&blend.segments, &blend.distance_segments, &blend.cani_hornus_segments})
    for (const auto& s : list->skeletons) largest = std::max({largest, s.radius_from, s.radius_to});
  for (const auto* list : {&blend.triangles, &blend.distance_triangles})
    for (const auto& s : list->skeletons) largest = std::max({largest, s.radii[0], s.radii[1], s.radii[2]});
  for (const auto* list : {&blend.arcs, &blend.distance_arcs})
    for (const auto& s : list->skeletons) largest = std::max({largest, s.radius_from, s.radius_to});
  return largest;
}

}  // namespace marrow
