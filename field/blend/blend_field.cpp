// Sums the primitives of a blend and corrects the sum.
#include "field/blend/blend_field.h"

#include <algorithm>
#include <cmath>

#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

template <Derivatives Order>
SkeletonSample inverse_point(const PointSkeleton& s, const Vec3d& p, int n) {
  return point_field<Order>(s, p, n);
}
template <Derivatives Order>
SkeletonSample inverse_segment(const SegmentSkeleton& s, const Vec3d& p, int n) {
  return segment_field<Order>(s, p, n);
}

// Calls visit(sample, list, index) for each primitive.
template <Derivatives Order, class Visit>
void for_each_primitive(const BlendField& blend, const Vec3d& p, const Visit& visit) {
  const int n = blend.degree;
  const auto all = [&](const auto& list, const auto& field) {
    for (std::size_t i = 0; i < list.size(); ++i) visit(field(list.skeletons[i], p, n), list, i);
  };
  if (blend.kernel != KernelFamily::Inverse) {
    const Kernel kernel{blend.kernel, n, blend.kernel_shape};
    all(blend.points, [&](const PointSkeleton& s, const Vec3d& q, int) { return point_field<Order>(s, q, kernel); });
    all(blend.segments,
        [&](const SegmentSkeleton& s, const Vec3d& q, int) { return segment_field<Order>(s, q, kernel); });
    return;
  }
  all(blend.points, inverse_point<Order>);
  all(blend.segments, inverse_segment<Order>);
  all(blend.distance_segments, distance_segment_field<Order>);
  all(blend.triangles, triangle_field<Order>);
  all(blend.arcs, arc_field<Order>);
}

bool has_materials(const BlendField& blend) {
  return !blend.points.materials.empty() || !blend.segments.materials.empty() ||
         !blend.distance_segments.materials.empty() || !blend.triangles.materials.empty() ||
         !blend.arcs.materials.empty();
}

bool is_on_skeleton(double sum) { return !(sum <= field_ceiling); }

// The sum of primitives together with that of their angles, weighted; each primitive is evaluated once.
struct WeightedSum {
  SkeletonSample sum;
  double angles = 0;        // sum f_i alpha_i
  Vec3d angles_gradient{};  // sum alpha_i grad f_i

  // grad (A / f) = (grad A - alpha grad f) / f
  AlphaSample alpha(double otherwise) const {
    if (!(sum.value > 0) || is_on_skeleton(sum.value)) return {.value = otherwise};
    const double mean = angles / sum.value;
    return {.value = mean, .gradient = (angles_gradient - sum.gradient * mean) / sum.value};
  }
};

template <Derivatives Order>
WeightedSum weighted_sum(const BlendField& blend, const Vec3d& p) {
  WeightedSum w;
  for_each_primitive<Order>(blend, p, [&](const SkeletonSample& s, const auto& list, std::size_t i) {
    w.sum += s;
    if (!blend.alpha_per_skeleton) return;
    w.angles += s.value * list.alphas[i];
    w.angles_gradient += s.gradient * list.alphas[i];
  });
  if (is_on_skeleton(w.sum.value)) w.sum = SkeletonSample::on_skeleton();
  return w;
}

Correction correction_with(const BlendField& blend, double alpha) {
  return Correction({blend.kernel, blend.degree, blend.kernel_shape}, alpha, blend.cavity, blend.projection);
}

}  // namespace

template <Derivatives Order>
SkeletonSample sum_of_primitives(const BlendField& blend, const Vec3d& p) {
  SkeletonSample sum;
  for_each_primitive<Order>(blend, p, [&](const SkeletonSample& s, const auto&, std::size_t) { sum += s; });
  return is_on_skeleton(sum.value) ? SkeletonSample::on_skeleton() : sum;
}

template SkeletonSample sum_of_primitives<Derivatives::ScaleInvariant>(const BlendField&, const Vec3d&);
template SkeletonSample sum_of_primitives<Derivatives::First>(const BlendField&, const Vec3d&);
template SkeletonSample sum_of_primitives<Derivatives::Second>(const BlendField&, const Vec3d&);

Correction correction_of(const BlendField& blend) { return correction_with(blend, blend.alpha); }

AlphaSample alpha_at(const BlendField& blend, const Vec3d& p) {
  if (!blend.alpha_per_skeleton) return {.value = blend.alpha};
  return weighted_sum<Derivatives::First>(blend, p).alpha(blend.alpha);
}

// grad C = dC/df grad f + dC/dG grad G + dC/dalpha grad alpha,  grad G = J^T grad_S f / G.
BlendSample evaluate(const BlendField& blend, const Vec3d& p) {
  const WeightedSum weighted = weighted_sum<Derivatives::Second>(blend, p);
  const SkeletonSample& sum = weighted.sum;
  const AlphaSample alpha = blend.alpha_per_skeleton ? weighted.alpha(blend.alpha) : AlphaSample{.value = blend.alpha};
  const double G = length(sum.si_gradient);
  const Correction::Partials c = correction_with(blend, alpha.value).partials(sum.value, G);
  BlendSample s{.sum = sum.value,
                .sum_gradient = sum.gradient,
                .si_gradient = sum.si_gradient,
                .si_norm = G,
                .alpha = alpha.value,
                .corrected = c.value,
                .corrected_gradient = sum.gradient * c.df};
  if (c.dG_over_G != 0) s.corrected_gradient += sum.si_jacobian.transposed_times(sum.si_gradient) * c.dG_over_G;
  if (blend.alpha_per_skeleton) s.corrected_gradient += alpha.gradient * c.dalpha;
  return s;
}

double corrected_value(const BlendField& blend, const Vec3d& p) {
  const WeightedSum weighted = weighted_sum<Derivatives::ScaleInvariant>(blend, p);
  const double alpha = blend.alpha_per_skeleton ? weighted.alpha(blend.alpha).value : blend.alpha;
  return correction_with(blend, alpha).value(weighted.sum.value, length(weighted.sum.si_gradient));
}

std::string untraceable_part(const BlendField& blend) {
  const auto evaluated_only = [](const std::string& what) {
    return what + " can be evaluated (probe, slice) but not rendered by this version";
  };
  if (blend.kernel == KernelFamily::Cauchy) return evaluated_only("`kernel: {cauchy: …}`");
  if (blend.kernel == KernelFamily::Compact) return evaluated_only("`kernel: {compact: …}`");
  if (!blend.distance_segments.empty()) return evaluated_only("`model: distance`");
  if (!blend.triangles.empty()) return evaluated_only("`triangle`");
  if (!blend.arcs.empty()) return evaluated_only("`circle` or `arc`");
  if (blend.alpha_per_skeleton) return evaluated_only("`alpha: per_skeleton`");
  return {};
}

MaterialId strongest_material(const BlendField& blend, const Vec3d& p) {
  MaterialId strongest;
  if (!has_materials(blend)) return strongest;
  double largest = -1;
  for_each_primitive<Derivatives::ScaleInvariant>(blend, p,
                                                  [&](const SkeletonSample& s, const auto& list, std::size_t i) {
                                                    if (s.value <= largest) return;
                                                    largest = s.value;
                                                    strongest = list.material(i);
                                                  });
  return strongest;
}

Box3 skeleton_bounds(const BlendField& blend) {
  Box3 box;
  for (const auto& s : blend.points.skeletons) box.include(s.at);
  for (const auto* list : {&blend.segments, &blend.distance_segments})
    for (const auto& s : list->skeletons) {
      box.include(s.from);
      box.include(s.to);
    }
  for (const auto& s : blend.triangles.skeletons)
    for (const Vec3d& vertex : s.vertices) box.include(vertex);
  for (const auto& s : blend.arcs.skeletons) {
    // of the whole circle
    Vec3d reach;
    for (std::size_t k = 0; k < 3; ++k)
      reach[k] = s.major * std::sqrt(s.axis1[k] * s.axis1[k] + s.axis2[k] * s.axis2[k]);
    box.include(s.center - reach);
    box.include(s.center + reach);
  }
  return box;
}

double largest_radius(const BlendField& blend) {
  double largest = 0;
  for (const auto& s : blend.points.skeletons) largest = std::max(largest, s.radius);
  for (const auto* list : {&blend.segments, &blend.distance_segments})
    for (const auto& s : list->skeletons) largest = std::max({largest, s.radius_from, s.radius_to});
  for (const auto& s : blend.triangles.skeletons) largest = std::max({largest, s.radii[0], s.radii[1], s.radii[2]});
  for (const auto& s : blend.arcs.skeletons) largest = std::max({largest, s.radius_from, s.radius_to});
  return largest;
}

}  // namespace marrow
