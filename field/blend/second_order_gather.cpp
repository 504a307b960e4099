// The rules of the angle as in gather.cpp, written once for numbers that carry their derivatives.
#include "field/blend/second_order_gather.h"

#include <cmath>
#include <concepts>
#include <vector>

#include "field/blend/angle/local_contact.h"
#include "field/blend/primitive_visit.h"
#include "field/blend/radius_marks.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

using X = HessianJet;

bool is_usable(const X& field) { return field.value > 0 && field.value <= field_ceiling; }

// Calls visit(sample, list, i) for each primitive; of a strand of distance segments the nearest counts.
template <class Visit>
void for_each_second_order(const BlendField& blend, const Vec3d& p, const Visit& visit) {
  const Kernel kernel = kernel_of(blend);
  const auto all = [&](const auto& list, const auto& field) {
    for (std::size_t i = 0; i < list.size(); ++i) visit(field(list.skeletons[i]), list, i);
  };
  const auto integral = [&](const auto& s) { return second_order(s, p, kernel); };
  const auto by_distance = [&](const auto& s) { return second_order_by_distance(s, p, kernel); };
  all(blend.points, integral);
  all(blend.segments, integral);
  visit_strands(
      blend.distance_segments,
      [&](const SegmentSkeleton& s) { return distance_field<Derivatives::ScaleInvariant>(s, p, kernel); },
      [&](const SkeletonSample&, const auto& list, std::size_t i) { visit(by_distance(list.skeletons[i]), list, i); });
  all(blend.cani_hornus_segments, [&](const SegmentSkeleton& s) { return second_order_of_cani_hornus(s, p); });
  all(blend.triangles, integral);
  all(blend.arcs, integral);
  all(blend.distance_triangles, by_distance);
  all(blend.distance_arcs, by_distance);
}

template <class Skeleton>
SecondOrderShares shares_of(const BlendField& blend, const X& field, const PrimitiveList<Skeleton>& list, std::size_t i,
                            const Vec3d& p) {
  const auto weighted = [&](const SecondOrderShares& at) { return SecondOrderShares{field * at[0], field * at[1]}; };
  if constexpr (std::same_as<Skeleton, SegmentSkeleton>)
    if (&list == &blend.cani_hornus_segments) return weighted(second_order_foot_shares(list.skeletons[i], p));
  if constexpr (!std::same_as<Skeleton, PointSkeleton>)
    if (is_by_distance(blend, list)) return weighted(second_order_nearest_shares(list.skeletons[i], p));
  return second_order_shares(list.skeletons[i], p, kernel_of(blend));
}

// sum f_i alpha_i / sum f_i
SecondOrderGathered per_skeleton(const BlendField& blend, const Vec3d& p) {
  SecondOrderGathered all;
  X angles;
  for_each_second_order(blend, p, [&](const SecondOrderSample& s, const auto& list, std::size_t i) {
    all.sum += s;
    angles += s.field * list.alphas[i];
    if (!is_usable(s.field) || !list.angle_varies(i)) return;
    const SecondOrderShares shares = shares_of(blend, s.field, list, i, p);
    angles += shares[0] * (list.alphas_to[i] - list.alphas[i]);
    if (!list.alphas_third.empty()) angles += shares[1] * (list.alphas_third[i] - list.alphas[i]);
  });
  if (is_usable(all.sum.field)) all.alpha = angles / all.sum.field;
  return all;
}

// Weighted by the field.
template <class Skeleton>
Vec3<X> direction_of(const BlendField& blend, const X& field, const PrimitiveList<Skeleton>& list, std::size_t i,
                     const Vec3d& p) {
  if constexpr (std::same_as<Skeleton, SegmentSkeleton>) {
    return constant<X>(normalize(list.skeletons[i].to - list.skeletons[i].from).vec()) * field;
  } else if constexpr (std::same_as<Skeleton, ArcSkeleton>) {
    if (!is_usable(field)) return {};
    return is_by_distance(blend, list) ? second_order_nearest_direction(list.skeletons[i], p) * field
                                       : second_order_direction(list.skeletons[i], p, kernel_of(blend));
  } else {
    return {};
  }
}

SecondOrderGathered by_direction(const BlendField& blend, const Vec3d& p) {
  SecondOrderGathered all;
  std::vector<SecondOrderStrand> strands(blend.direction_bounds.size());
  for (std::size_t i = 0; i < strands.size(); ++i) strands[i].bounds = blend.direction_bounds[i];
  for_each_second_order(blend, p, [&](const SecondOrderSample& s, const auto& list, std::size_t i) {
    all.sum += s;
    SecondOrderStrand& strand = strands[list.strands[i]];
    strand.field += s.field;
    strand.direction += direction_of(blend, s.field, list, i, p);
  });
  if (is_usable(all.sum.field)) all.alpha = directional_alpha(strands);
  return all;
}

SecondOrderGathered by_local_contact(const BlendField& blend, const Vec3d& p) {
  SecondOrderGathered all;
  const LocalContact& rule = *blend.local_contact;
  const Kernel near_kernel{KernelFamily::Inverse, LocalContact::near_degree, 1};
  const double reference = reference_radius(blend);
  X linear, squared, near;
  for_each_second_order(blend, p, [&](const SecondOrderSample& s, const auto& list, std::size_t i) {
    all.sum += s;
    const double l = radius_mark(list, i, reference);
    linear += s.field * l;
    squared += s.field * (l * l);
    if (rule.adapts_to_density()) near += second_order(list.skeletons[i], p, near_kernel).field;
  });
  const X& f = all.sum.field;
  if (is_usable(f)) all.alpha = rule.at(f, 4.0 * (squared / f - square(linear / f)), near);
  return all;
}

SecondOrderGathered with_angle(const BlendField& blend, const Vec3d& p, const X& alpha) {
  SecondOrderGathered all{.sum = {}, .alpha = alpha};
  for_each_second_order(blend, p, [&](const SecondOrderSample& s, const auto&, std::size_t) { all.sum += s; });
  return all;
}

SecondOrderGathered gather_by_rule(const BlendField& blend, const Vec3d& p) {
  if (blend.alpha_per_skeleton) return per_skeleton(blend, p);
  if (!blend.direction_bounds.empty()) return by_direction(blend, p);
  if (blend.local_contact) return by_local_contact(blend, p);
  if (blend.alpha_source) return with_angle(blend, p, blend.alpha_source->second_order_at(p));
  return with_angle(blend, p, blend.alpha);
}

}  // namespace

SecondOrderGathered second_order_gather(const BlendField& blend, const Vec3d& p) {
  SecondOrderGathered all = gather_by_rule(blend, p);
  if (!is_usable(all.sum.field)) all.alpha = blend.alpha;
  if (!(all.sum.field.value <= field_ceiling)) all.sum = SecondOrderSample::on_skeleton();
  return all;
}

}  // namespace marrow
