// One loop over the primitives for each rule of the angle.
#include "field/blend/gather.h"

#include <cmath>
#include <concepts>
#include <vector>

#include "field/blend/primitive_visit.h"
#include "field/blend/radius_marks.h"
#include "field/math/elementary.h"
#include "field/skeleton/shares.h"

namespace marrow {
namespace {

template <class Skeleton>
Shares shares_of(const BlendField& blend, const SkeletonSample& s, const PrimitiveList<Skeleton>& list, std::size_t i,
                 const Vec3d& p) {
  if constexpr (std::same_as<Skeleton, SegmentSkeleton>)
    if (&list == &blend.cani_hornus_segments) return foot_shares(list.skeletons[i], p, s);
  if constexpr (!std::same_as<Skeleton, PointSkeleton>)
    if (is_by_distance(blend, list)) return nearest_shares(list.skeletons[i], p, s);
  return integral_shares(list.skeletons[i], p, kernel_of(blend));
}

// f_i alpha_i of a primitive, with linear angles weighted along it.
struct Angles {
  double value = 0;
  Vec3d gradient{};
  void add(const BlendField& blend, const SkeletonSample& s, const auto& list, std::size_t i, const Vec3d& p) {
    value += s.value * list.alphas[i];
    gradient += s.gradient * list.alphas[i];
    if (!is_usable(s) || !list.angle_varies(i)) return;
    const Shares shares = shares_of(blend, s, list, i, p);
    add(shares[0], list.alphas_to[i] - list.alphas[i]);
    if (!list.alphas_third.empty()) add(shares[1], list.alphas_third[i] - list.alphas[i]);
  }
  void add(const ShareSample& share, double rise) {
    value += share.value * rise;
    gradient += share.gradient * rise;
  }
};

// grad (A / f) = (grad A - alpha grad f) / f
// Here and below each_primitive(visit) does as for_each_primitive().
template <class EachPrimitive>
Gathered per_skeleton(const BlendField& blend, const Vec3d& p, const EachPrimitive& each_primitive) {
  Gathered all;
  Angles angles;
  each_primitive([&](const SkeletonSample& s, const auto& list, std::size_t i) {
    all.sum += s;
    angles.add(blend, s, list, i, p);
  });
  if (!is_usable(all.sum)) return all;
  const double mean = angles.value / all.sum.value;
  all.alpha = {.value = mean, .gradient = (angles.gradient - all.sum.gradient * mean) / all.sum.value};
  return all;
}

// The sum of a skeleton's directions, weighted by its field. Points and triangles have none.
template <class Skeleton>
DirectionSample direction_of(const BlendField& blend, const SkeletonSample& s, const PrimitiveList<Skeleton>& list,
                             std::size_t i, const Vec3d& p) {
  if constexpr (std::same_as<Skeleton, SegmentSkeleton>) {
    const Vec3d u = normalize(list.skeletons[i].to - list.skeletons[i].from).vec();
    return {u * s.value, Matrix3::outer(u, s.gradient)};
  } else if constexpr (std::same_as<Skeleton, ArcSkeleton>) {
    if (!is_usable(s)) return {};
    return is_by_distance(blend, list) ? nearest_direction(list.skeletons[i], p, s)
                                       : arc_direction(list.skeletons[i], p, kernel_of(blend));
  } else {
    return {};
  }
}

// each_direction(visit) calls visit(sample, direction, strand) for each primitive.
template <Derivatives Order, class EachDirection>
Gathered by_direction(const BlendField& blend, const EachDirection& each_direction) {
  Gathered all;
  std::vector<Strand> strands(blend.direction_bounds.size());
  for (std::size_t i = 0; i < strands.size(); ++i) strands[i].bounds = blend.direction_bounds[i];
  each_direction([&](const SkeletonSample& s, const DirectionSample& direction, std::size_t index) {
    all.sum += s;
    Strand& strand = strands[index];
    strand.field += s.value;
    strand.field_gradient += s.gradient;
    strand.direction += direction.value;
    if constexpr (Order >= Derivatives::First) strand.direction_jacobian += direction.jacobian;
  });
  if (is_usable(all.sum)) all.alpha = directional_alpha(strands, Order >= Derivatives::First);
  return all;
}

SkeletonSample near_field_of(const auto& skeleton, const Vec3d& p) {
  constexpr int m = LocalContact::near_degree;
  if constexpr (requires { segment_field<Derivatives::First>(skeleton, p, m); })
    return segment_field<Derivatives::First>(skeleton, p, m);
  else if constexpr (requires { point_field<Derivatives::First>(skeleton, p, m); })
    return point_field<Derivatives::First>(skeleton, p, m);
  else if constexpr (requires { triangle_field<Derivatives::First>(skeleton, p, m); })
    return triangle_field<Derivatives::First>(skeleton, p, m);
  else return arc_field<Derivatives::First>(skeleton, p, m);
}

// each_near(visit) calls visit(sample, near sample, list, i) for each primitive.
template <class EachNear>
Neighbourhood told(const BlendField& blend, const EachNear& each_near, SkeletonSample& sum) {
  const LocalContact& rule = *blend.local_contact;
  const double reference = reference_radius(blend);
  MarkSums marks;
  SkeletonSample near;
  each_near([&](const SkeletonSample& s, const SkeletonSample& n, const auto& list, std::size_t i) {
    sum += s;
    if (rule.adapts_to_radii()) marks.add(s, radius_mark(list, i, reference));
    near += n;
  });
  return neighbourhood(rule, sum, marks, near);
}

SkeletonSample near_field_for(const LocalContact& rule, const auto& skeleton, const Vec3d& p) {
  return rule.adapts_to_density() ? near_field_of(skeleton, p) : SkeletonSample{};
}

template <Derivatives Order>
Gathered by_local_contact(const BlendField& blend, const Vec3d& p) {
  Gathered all;
  const LocalContact& rule = *blend.local_contact;
  const auto each_near = [&](const auto& visit) {
    for_each_primitive<Order>(blend, p, [&](const SkeletonSample& s, const auto& list, std::size_t i) {
      visit(s, near_field_for(rule, list.skeletons[i], p), list, i);
    });
  };
  const Neighbourhood place = told(blend, each_near, all.sum);
  if (is_usable(all.sum)) all.alpha = rule.at(place);
  return all;
}

template <Derivatives Order>
Gathered with_angle(const BlendField& blend, const Vec3d& p, const AlphaSample& alpha) {
  Gathered all{.sum = {}, .alpha = alpha};
  for_each_primitive<Order>(blend, p, [&](const SkeletonSample& s, const auto&, std::size_t) { all.sum += s; });
  return all;
}

template <Derivatives Order>
Gathered gather_by_rule(const BlendField& blend, const Vec3d& p) {
  const auto each_primitive = [&](const auto& visit) { for_each_primitive<Order>(blend, p, visit); };
  if (blend.alpha_per_skeleton) return per_skeleton(blend, p, each_primitive);
  const auto each_direction = [&](const auto& visit) {
    each_primitive([&](const SkeletonSample& s, const auto& list, std::size_t i) {
      visit(s, direction_of(blend, s, list, i, p), list.strands[i]);
    });
  };
  if (!blend.direction_bounds.empty()) return by_direction<Order>(blend, each_direction);
  if (blend.local_contact) return by_local_contact<Order>(blend, p);
  if (blend.alpha_source) return with_angle<Order>(blend, p, blend.alpha_source->at(p));
  return with_angle<Order>(blend, p, {.value = blend.alpha});
}

}  // namespace

PartsAround parts_around(const BlendField& blend, const Vec3d& p, const std::vector<PrimitiveBounds>& parts) {
  PartsAround around;
  const LocalContact& rule = *blend.local_contact;
  const auto each_near = [&](const auto& visit) {
    visit_parts(blend, parts, [&](const PrimitiveBounds& part, const auto& list, std::size_t i) {
      around.near.push_back(part.counts() ? near_field_for(rule, list.skeletons[i], p) : SkeletonSample{});
      visit(part.sample, around.near.back(), list, i);
    });
  };
  SkeletonSample sum;
  around.place = told(blend, each_near, sum);
  return around;
}

AlphaSample alpha_of_skeletons(const BlendField& blend, const Vec3d& p, const std::vector<PrimitiveBounds>& parts) {
  const auto each_primitive = [&](const auto& visit) {
    visit_parts(blend, parts,
                [&](const PrimitiveBounds& part, const auto& list, std::size_t i) { visit(part.sample, list, i); });
  };
  return per_skeleton(blend, p, each_primitive).alpha;
}

std::vector<DirectionSample> directions_of(const BlendField& blend, const Vec3d& p,
                                           const std::vector<PrimitiveBounds>& parts) {
  std::vector<DirectionSample> all;
  all.reserve(parts.size());
  visit_parts(blend, parts, [&](const PrimitiveBounds& part, const auto& list, std::size_t i) {
    all.push_back(direction_of(blend, part.sample, list, i, p));
  });
  return all;
}

AlphaSample alpha_of_directions(const BlendField& blend, const std::vector<PrimitiveBounds>& parts,
                                const std::vector<DirectionSample>& directions) {
  const auto each_direction = [&](const auto& visit) {
    auto direction = directions.begin();
    visit_parts(blend, parts, [&](const PrimitiveBounds& part, const auto& list, std::size_t i) {
      visit(part.sample, *direction++, list.strands[i]);
    });
  };
  return by_direction<Derivatives::First>(blend, each_direction).alpha;
}

template <Derivatives Order>
Gathered gather(const BlendField& blend, const Vec3d& p) {
  Gathered all = gather_by_rule<Order>(blend, p);
  if (!is_usable(all.sum)) all.alpha = {.value = blend.alpha};
  if (!(all.sum.value <= field_ceiling)) all.sum = SkeletonSample::on_skeleton();
  return all;
}

template Gathered gather<Derivatives::ScaleInvariant>(const BlendField&, const Vec3d&);
template Gathered gather<Derivatives::First>(const BlendField&, const Vec3d&);
template Gathered gather<Derivatives::Second>(const BlendField&, const Vec3d&);

}  // namespace marrow
