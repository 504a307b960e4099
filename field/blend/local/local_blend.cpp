#include "field/blend/local/local_blend.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "field/blend/bounds/angle/alpha_bounds.h"
#include "field/blend/bounds/angle/local_contact_angles.h"
#include "field/blend/bounds/sum/distances_in_reach.h"
#include "field/blend/bounds/sum/sum_bounds.h"
#include "field/blend/local/far_expansion.h"
#include "field/blend/local/source_maker.h"
#include "field/blend/primitive_visit.h"
#include "field/blend/radius_marks.h"
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

// Whether the angle is a sum over all skeletons as they are.
bool angle_is_of_skeletons(const BlendField& blend) {
  if (!blend.local_contact) return blend.alpha_varies() && !blend.alpha_source;
  return !blend.distance_segments.empty() || !blend.distance_triangles.empty() || !blend.distance_arcs.empty() ||
         !blend.cani_hornus_segments.empty();
}

// Of the contact angle that adapts to radii.
bool has_marks(const BlendField& blend) { return blend.local_contact && blend.local_contact->adapts_to_radii(); }

bool adapts_to_density(const BlendField& blend) {
  return blend.local_contact && blend.local_contact->adapts_to_density();
}

// Those whose support meets the ball around the box.
template <class Skeleton>
void keep_reaching(const PrimitiveList<Skeleton>& from, double support, const Box3& box, PrimitiveList<Skeleton>& to) {
  const Vec3d center = box.center();
  const double rho = 0.5 * length(box.size()) * (1 + 1e-9);
  for (const Skeleton& s : from.skeletons)
    if (distance_to(s, center) <= rho + support * largest_radius(s)) to.skeletons.push_back(s);
}

// A polynomial is moved for so many: for 60 or 300 pictures take as long, but cells 1.5 or 1.1 GB of a cut neuron, and
// for 800 a third longer where many rays meet a cell.
constexpr std::size_t moving_it_is_worth = 200;
// How many sources take the time of a polynomial, and of closed forms.
constexpr std::size_t polynomial_is_worth = 400, point_is_worth = 20, segment_is_worth = 100, arc_is_worth = 20000;
// Sources are gone through again where so many of them are far: lists of boxes in boxes shrink by it each time.
constexpr double enough_far = 0.3;
// A primitive becomes some eight sources, which share what it may be off by.
constexpr double sources_of_primitive = 8;

// Of a strand by distance smaller boxes see one segment, or the two of a joint.
constexpr std::size_t few_segments = 32, few_of_strand = 2;

bool has_many_candidates(const PrimitiveList<SegmentSkeleton>& list) {
  std::size_t strands = 0;
  for_each_strand(list, [&](std::size_t, std::span<const SegmentSkeleton>) { ++strands; });
  return list.size() > few_segments + few_of_strand * strands;
}

}  // namespace

LocalBlend::LocalBlend(const BlendField& blend, std::shared_ptr<const LocalBlend> outer)
    : blend_(blend),
      outer_(std::move(outer)),
      correction_(correction_of(blend)),
      rest_(without_primitives(blend)),
      sources_(blend.degree, has_marks(blend)),
      reference_radius_(outer_ ? outer_->reference_radius_ : reference_radius(blend)) {
  if (!outer_) return;
  f_error_ = outer_->f_error_;
  S_error_ = outer_->S_error_;
}

std::shared_ptr<const LocalBlend> LocalBlend::make(const BlendField& blend, std::shared_ptr<const LocalBlend> outer,
                                                   const Box3& box) {
  if (angle_is_of_skeletons(blend) || !is_finite(box.lower) || !is_finite(box.upper)) return outer;
  const BlendField& from = outer ? outer->rest_ : blend;
  std::shared_ptr<LocalBlend> made(new LocalBlend(blend, outer));
  BlendField& rest = made->rest_;
  DistancesInReach distances = distances_in_reach(from.distance_segments, kernel_of(blend),
                                                  {.center = box.center(), .radius = 0.5 * length(box.size())});
  rest.distance_segments = std::move(distances.segments);
  if (blend.kernel == KernelFamily::Compact) {
    keep_reaching(from.points, blend.kernel_shape, box, rest.points);
    keep_reaching(from.segments, blend.kernel_shape, box, rest.segments);
    keep_reaching(from.triangles, blend.kernel_shape, box, rest.triangles);
    keep_reaching(from.arcs, blend.kernel_shape, box, rest.arcs);
    keep_reaching(from.distance_triangles, blend.kernel_shape, box, rest.distance_triangles);
    keep_reaching(from.distance_arcs, blend.kernel_shape, box, rest.distance_arcs);
    for (const PointSkeleton& end : distances.ends) rest.points.skeletons.push_back(end);
  } else {
    SourceMaker maker(blend, box, has_marks(blend), largest_error, 1 / static_cast<double>(blend.size()));
    maker.add(from.points);
    maker.add(from.segments);
    maker.add(from.triangles);
    maker.add(from.arcs);
    PrimitiveList<PointSkeleton> ends;
    ends.skeletons = std::move(distances.ends);
    maker.add(ends);
    rest.points = std::move(maker.rest_points);
    rest.segments = std::move(maker.rest_segments);
    rest.triangles = std::move(maker.rest_triangles);
    rest.arcs = std::move(maker.rest_arcs);
    made->sources_ = std::move(maker.sources);
    made->f_error_ += maker.f_error;
    made->S_error_ += maker.S_error;
    made->fold_far_sources(box);
    rest.distance_triangles = from.distance_triangles;
    rest.distance_arcs = from.distance_arcs;
  }
  rest.cani_hornus_segments = from.cani_hornus_segments;
  const bool fewer_near = made->keep_near(outer.get(), box);
  return !made->sources_.empty() || made->far_ || rest.size() < from.size() || fewer_near ? made : outer;
}

// Returns whether some are left out that the box around it keeps.
bool LocalBlend::keep_near(const LocalBlend* outer, const Box3& box) {
  if (!adapts_to_density(blend_)) return false;
  near_ = std::make_unique<const NearSkeletons>(outer != nullptr ? outer->near_->within(box)
                                                                 : NearSkeletons(blend_).within(box));
  return near_->size() < (outer != nullptr ? outer->near_->size() : blend_.size());
}

const LocalBlend& LocalBlend::last() const {
  const LocalBlend* here = this;
  while (here->outer_) here = here->outer_.get();
  return *here;
}

// All sources of the boxes around it anew: into a polynomial, or a list of its own.
void LocalBlend::fold_far_sources(const Box3& box) {
  const FarPolynomial *const outer_far = last().far_.get(), *const outer_marks = last().far_marks_.get();
  const double share = 1 / (sources_of_primitive * static_cast<double>(blend_.size()));
  FarExpansion expansion(box, blend_.kernel == KernelFamily::Cauchy, is_marked(), largest_error, share);
  std::vector<std::optional<FarExpansion::View>> views;
  for_each_sums([&](const SourceSums& sums) {
    for (std::size_t i = 0; i < sums.count(); ++i) views.push_back(expansion.seen(sums[i], sums.exponent()));
  });
  const auto is_far = [](const auto& view) { return view.has_value(); };
  const auto far = static_cast<std::size_t>(std::count_if(views.begin(), views.end(), is_far));
  if (static_cast<double>(far) < enough_far * static_cast<double>(views.size()) ||
      far < (outer_far == nullptr ? polynomial_is_worth : moving_it_is_worth))
    return;
  SourceLists rest(blend_.degree, is_marked());
  auto view = views.begin();
  for_each_sums([&](const SourceSums& sums) {
    SourceSums& list = rest.with(sums.exponent());
    const auto end = view + static_cast<std::ptrdiff_t>(sums.count());
    list.reserve(list.count() + sums.count() - static_cast<std::size_t>(std::count_if(view, end, is_far)));
    for (std::size_t i = 0; i < sums.count(); ++i, ++view)
      if (*view) expansion.add(sums[i], sums.exponent(), **view);
      else list.add(sums[i]);
  });
  far_ = expansion.polynomial(outer_far);
  if (is_marked()) far_marks_ = expansion.marks(outer_marks);
  sources_ = std::move(rest);
  f_error_ += expansion.f_error();
  S_error_ += expansion.S_error();
  outer_ = nullptr;
}

bool LocalBlend::is_marked() const { return has_marks(blend_); }

template <Derivatives Order>
SkeletonSample LocalBlend::sum_at(const Vec3d& p, MarkSums& marks) const {
  const bool marked = is_marked();
  SkeletonSample sum;
  for_each_primitive<Order>(rest_, p, [&](const SkeletonSample& s, const auto& list, std::size_t i) {
    sum += s;
    if (marked) marks.add(s, radius_mark(list, i, reference_radius_));
  });
  for_each_sums([&](const SourceSums& s) {
    if constexpr (Order == Derivatives::ScaleInvariant) sum += s.value_at(p);
    else sum += s.at(p).sum;
    if (marked) marks += s.marks_at(p);
  });
  const LocalBlend& outermost = last();
  if (!outermost.far_) return sum;
  if constexpr (Order == Derivatives::ScaleInvariant) sum += outermost.far_->value_at(p);
  else sum += outermost.far_->at(p);
  if (marked) marks += outermost.far_marks_->marks_at(p);
  return sum;
}

Neighbourhood LocalBlend::place_at(const Vec3d& p, const SkeletonSample& sum, const MarkSums& marks) const {
  return neighbourhood(*blend_.local_contact, sum, marks, near_ ? near_->at(p) : SkeletonSample{});
}

AlphaSample LocalBlend::angle_at(const Vec3d& p, const SkeletonSample& sum, const MarkSums& marks) const {
  if (blend_.alpha_source) return blend_.alpha_source->at(p);
  if (!blend_.local_contact || !is_usable(sum)) return {.value = blend_.alpha};
  return blend_.local_contact->at(place_at(p, sum, marks));
}

double LocalBlend::value(const Vec3d& p) const {
  MarkSums marks;
  const SkeletonSample sum = sum_at<Derivatives::ScaleInvariant>(p, marks);
  const double G = length(sum.si_gradient);
  if (!blend_.alpha_varies()) return correction_.value(sum.value, G);
  return correction_at(blend_, angle_at(p, sum, marks).value).value(sum.value, G);
}

LocalBlend::Sample LocalBlend::evaluate(const Vec3d& p) const {
  MarkSums marks;
  const SkeletonSample sum = sum_at<Derivatives::Second>(p, marks);
  const AlphaSample alpha = angle_at(p, sum, marks);
  const double G = length(sum.si_gradient);
  const Correction::Partials c = blend_.alpha_varies() ? correction_at(blend_, alpha.value).partials(sum.value, G)
                                                       : correction_.partials(sum.value, G);
  Vec3d gradient = sum.gradient * c.df;
  if (blend_.alpha_varies()) gradient += alpha.gradient * c.dalpha;
  if (c.dG_over_G != 0) gradient += sum.si_jacobian.transposed_times(sum.si_gradient) * c.dG_over_G;
  return {c.value, gradient};
}

AngleBounds LocalBlend::angles_in(const Box3& box, const SumBounds& sum) const {
  if (!blend_.local_contact) return alpha_bounds(blend_, sum, box);
  MarkSums marks;
  const SkeletonSample middle = sum_at<Derivatives::Second>(sum.center(), marks);
  const double near_slope = near_ ? near_->log_slope(sum.center(), sum.rho()) : 0;
  return local_contact_angles(blend_, place_at(sum.center(), middle, marks), near_slope, sum);
}

BlendBounds LocalBlend::bounds(const Box3& box, Wanted wanted, const Within& within) const {
  if (!is_finite(box.center()) || !is_finite(box.size())) return blend_bounds(blend_, box, wanted, within);
  SumBounds sum(rest_, box, wanted, within);
  for_each_sums([&](const SourceSums& s) { sum.add(s); });
  if (const FarPolynomial* far = last().far_.get()) sum.add(*far);
  if (!blend_.alpha_varies()) return blend_bounds(blend_, sum, {blend_.alpha, {}}, correction_);
  const AngleBounds angle = angles_in(box, sum);
  return blend_bounds(blend_, sum, angle, correction_at(blend_, angle.value.lo));
}

std::size_t LocalBlend::near_count() const {
  if (rest_.kernel == KernelFamily::Compact) return 0;
  return rest_.points.size() + rest_.segments.size() + rest_.arcs.size();
}

bool LocalBlend::is_mostly_near() const {
  if (has_many_candidates(rest_.distance_segments)) return true;
  if (rest_.kernel == KernelFamily::Compact) return false;
  const std::size_t near = point_is_worth * rest_.points.size() + segment_is_worth * rest_.segments.size() +
                           arc_is_worth * rest_.arcs.size();
  return near > source_count() + (last().far_ ? polynomial_is_worth : 0);
}

std::size_t LocalBlend::source_count() const {
  std::size_t count = 0;
  for_each_sums([&](const SourceSums& s) { count += s.count(); });
  return count;
}

std::size_t LocalBlend::bytes() const {
  return sizeof *this + sources_.bytes() + rest_.size() * sizeof(ArcSkeleton) +
         (near_ ? sizeof *near_ + near_->size() * sizeof(SegmentSkeleton) : 0) + (far_ ? far_->bytes() : 0) +
         (far_marks_ ? far_marks_->bytes() : 0);
}

}  // namespace marrow
