// Sums the primitives of a blend and corrects the sum.
#include "field/blend/blend_field.h"

#include <algorithm>

#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

// Calls visit(value, material) for each primitive.
template <class Visit>
void for_each_value(const BlendField& blend, const Vec3d& p, const Visit& visit) {
  constexpr auto order = Derivatives::ScaleInvariant;
  const int n = blend.degree;
  for (std::size_t i = 0; i < blend.points.size(); ++i)
    visit(point_field<order>(blend.points.skeletons[i], p, n).value, blend.points.material(i));
  for (std::size_t i = 0; i < blend.segments.size(); ++i)
    visit(segment_field<order>(blend.segments.skeletons[i], p, n).value, blend.segments.material(i));
  for (std::size_t i = 0; i < blend.distance_segments.size(); ++i)
    visit(distance_segment_field<order>(blend.distance_segments.skeletons[i], p, n).value,
          blend.distance_segments.material(i));
}

bool has_materials(const BlendField& blend) {
  return !blend.points.materials.empty() || !blend.segments.materials.empty() ||
         !blend.distance_segments.materials.empty();
}

}  // namespace

template <Derivatives Order>
SkeletonSample sum_of_primitives(const BlendField& blend, const Vec3d& p) {
  SkeletonSample sum;
  for (const auto& s : blend.points.skeletons) sum += point_field<Order>(s, p, blend.degree);
  for (const auto& s : blend.segments.skeletons) sum += segment_field<Order>(s, p, blend.degree);
  for (const auto& s : blend.distance_segments.skeletons) sum += distance_segment_field<Order>(s, p, blend.degree);
  if (!(sum.value <= field_ceiling)) return SkeletonSample::on_skeleton();
  return sum;
}

template SkeletonSample sum_of_primitives<Derivatives::ScaleInvariant>(const BlendField&, const Vec3d&);
template SkeletonSample sum_of_primitives<Derivatives::First>(const BlendField&, const Vec3d&);
template SkeletonSample sum_of_primitives<Derivatives::Second>(const BlendField&, const Vec3d&);

Correction correction_of(const BlendField& blend) {
  return Correction(blend.degree, blend.alpha, blend.cavity, blend.projection);
}

// grad C = dC/df grad f + dC/dG grad G,  grad G = J^T grad_S f / G.
BlendSample evaluate(const BlendField& blend, const Vec3d& p) {
  const SkeletonSample sum = sum_of_primitives<Derivatives::Second>(blend, p);
  const double G = length(sum.si_gradient);
  const Correction::Partials c = correction_of(blend).partials(sum.value, G);
  BlendSample s{.sum = sum.value,
                .sum_gradient = sum.gradient,
                .si_gradient = sum.si_gradient,
                .si_norm = G,
                .alpha = blend.alpha,
                .corrected = c.value,
                .corrected_gradient = sum.gradient * c.df};
  if (c.dG_over_G != 0) s.corrected_gradient += sum.si_jacobian.transposed_times(sum.si_gradient) * c.dG_over_G;
  return s;
}

double corrected_value(const BlendField& blend, const Vec3d& p) {
  const SkeletonSample sum = sum_of_primitives<Derivatives::ScaleInvariant>(blend, p);
  return correction_of(blend).value(sum.value, length(sum.si_gradient));
}

MaterialId strongest_material(const BlendField& blend, const Vec3d& p) {
  MaterialId strongest;
  if (!has_materials(blend)) return strongest;
  double largest = -1;
  for_each_value(blend, p, [&](double value, MaterialId material) {
    if (value <= largest) return;
    largest = value;
    strongest = material;
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
  return box;
}

double largest_radius(const BlendField& blend) {
  double largest = 0;
  for (const auto& s : blend.points.skeletons) largest = std::max(largest, s.radius);
  for (const auto* list : {&blend.segments, &blend.distance_segments})
    for (const auto& s : list->skeletons) largest = std::max({largest, s.radius_from, s.radius_to});
  return largest;
}

}  // namespace marrow
