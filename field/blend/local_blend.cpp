#include "field/blend/local_blend.h"

#include <utility>

#include "field/blend/source_maker.h"
#include "field/blend/sum_bounds.h"
#include "field/kernel/inverse_family.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

// A blend with the same settings and no primitives.
BlendField without_primitives(const BlendField& blend) {
  BlendField b;
  b.degree = blend.degree;
  b.kernel = blend.kernel;
  b.kernel_shape = blend.kernel_shape;
  b.alpha = blend.alpha;
  b.cavity = blend.cavity;
  b.projection = blend.projection;
  return b;
}

// Those whose support meets the ball around the box.
template <class Skeleton>
void keep_reaching(const PrimitiveList<Skeleton>& from, double support, const Box3& box, PrimitiveList<Skeleton>& to) {
  const Vec3d center = box.center();
  const double rho = 0.5 * length(box.size()) * (1 + 1e-9);
  for (const Skeleton& s : from.skeletons)
    if (distance_to(s, center) <= rho + support * largest_radius(s)) to.skeletons.push_back(s);
}

}  // namespace

LocalBlend::LocalBlend(const BlendField& blend, std::shared_ptr<const LocalBlend> outer)
    : blend_(blend),
      outer_(std::move(outer)),
      correction_(correction_of(blend)),
      rest_(without_primitives(blend)),
      points_(kernel_degree(blend.degree, 0)),
      curves_(kernel_degree(blend.degree, 1)),
      surfaces_(kernel_degree(blend.degree, 2)) {
  if (!outer_) return;
  f_error_ = outer_->f_error_;
  S_error_ = outer_->S_error_;
}

std::shared_ptr<const LocalBlend> LocalBlend::make(const BlendField& blend, std::shared_ptr<const LocalBlend> outer,
                                                   const Box3& box) {
  if (blend.alpha_varies() || !is_finite(box.lower) || !is_finite(box.upper)) return outer;
  const BlendField& from = outer ? outer->rest_ : blend;
  std::shared_ptr<LocalBlend> made(new LocalBlend(blend, outer));
  BlendField& rest = made->rest_;
  if (blend.kernel == KernelFamily::Compact) {
    keep_reaching(from.points, blend.kernel_shape, box, rest.points);
    keep_reaching(from.segments, blend.kernel_shape, box, rest.segments);
    keep_reaching(from.triangles, blend.kernel_shape, box, rest.triangles);
    keep_reaching(from.arcs, blend.kernel_shape, box, rest.arcs);
  } else {
    SourceMaker maker(blend, box, largest_error, 1 / static_cast<double>(blend.size()));
    const auto add_all = [&](const auto& list) {
      for (const auto& s : list.skeletons) maker.add(s);
    };
    add_all(from.points);
    add_all(from.segments);
    add_all(from.triangles);
    add_all(from.arcs);
    rest.points = std::move(maker.rest_points);
    rest.segments = std::move(maker.rest_segments);
    rest.triangles = std::move(maker.rest_triangles);
    rest.arcs = std::move(maker.rest_arcs);
    made->points_ = std::move(maker.points);
    made->curves_ = std::move(maker.curves);
    made->surfaces_ = std::move(maker.surfaces);
    made->f_error_ += maker.f_error;
    made->S_error_ += maker.S_error;
  }
  rest.distance_segments = from.distance_segments;
  rest.distance_triangles = from.distance_triangles;
  rest.distance_arcs = from.distance_arcs;
  rest.cani_hornus_segments = from.cani_hornus_segments;
  const bool has_sources = !made->points_.empty() || !made->curves_.empty() || !made->surfaces_.empty();
  return has_sources || rest.size() < from.size() ? made : outer;
}

double LocalBlend::value(const Vec3d& p) const {
  SkeletonSample sum = sum_of_primitives<Derivatives::ScaleInvariant>(rest_, p);
  for_each_sums([&](const SourceSums& s) { sum += s.value_at(p); });
  return correction_.value(sum.value, length(sum.si_gradient));
}

LocalBlend::Sample LocalBlend::evaluate(const Vec3d& p) const {
  SkeletonSample sum = sum_of_primitives<Derivatives::Second>(rest_, p);
  for_each_sums([&](const SourceSums& s) { sum += s.at(p).sum; });
  const Correction::Partials c = correction_.partials(sum.value, length(sum.si_gradient));
  Vec3d gradient = sum.gradient * c.df;
  if (c.dG_over_G != 0) gradient += sum.si_jacobian.transposed_times(sum.si_gradient) * c.dG_over_G;
  return {c.value, gradient};
}

BlendBounds LocalBlend::bounds(const Box3& box, Wanted wanted, const Stretch* stretch) const {
  if (!is_finite(box.center()) || !is_finite(box.size())) return blend_bounds(blend_, box, wanted, stretch);
  SumBounds sum(rest_, box, wanted, stretch);
  for_each_sums([&](const SourceSums& s) { sum.add(s); });
  return blend_bounds(blend_, sum, {blend_.alpha, {}}, correction_);
}

std::size_t LocalBlend::near_count() const {
  if (rest_.kernel == KernelFamily::Compact) return 0;
  return rest_.points.size() + rest_.segments.size() + rest_.arcs.size();
}

std::size_t LocalBlend::source_count() const {
  std::size_t count = 0;
  for_each_sums([&](const SourceSums& s) { count += s.count(); });
  return count;
}

std::size_t LocalBlend::bytes() const {
  return sizeof *this + points_.bytes() + curves_.bytes() + surfaces_.bytes() + rest_.size() * sizeof(ArcSkeleton);
}

}  // namespace marrow
