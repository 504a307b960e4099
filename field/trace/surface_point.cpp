// Normals at hits, and points beside them from which rays can leave.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "field/number/interval.h"
#include "field/trace/blend_tracer_state.h"

namespace marrow {
namespace {

constexpr auto most_together = static_cast<std::size_t>(lanes);

Vec3d vec(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

template <std::size_t Count>
void set(float (&to)[Count][lanes], std::size_t lane, const float (&v)[Count]) {
  for (std::size_t i = 0; i < Count; ++i) to[i][lane] = v[i];
}

void set(SurfaceLanes& hits, std::size_t lane, const PointField& f, const BlockLevel& fine) {
  hits.f[lane] = f.f;
  set(hits.gradient, lane, f.gradient);
  set(hits.si_gradient, lane, f.si_gradient);
  set(hits.hessian, lane, f.hessian);
  hits.nearest[lane] = f.nearest;
  hits.second[lane] = f.second;
  hits.third[lane] = f.third;
  hits.f_error[lane] = static_cast<float>(fine.f_error);
  hits.g_error[lane] = static_cast<float>(fine.gradient_error);
}

// Twice the errors, since a ray may start in a neighbour.
void set_share(SurfaceLanes& hits, std::size_t lane, const Block& block, const Vec3d& place, const PointField& f,
               int degree) {
  const BlockLevel& fine = block.fine();
  const bool patched = block.patches() != nullptr;
  ShareAt at{.share = static_cast<double>(f.share),
             .gradient = vec(f.share_gradient),
             .bend = static_cast<double>(f.share_bend),
             .error = fine.angle_error};
  if (patched) at = block.share(place);
  const double error = 2 * (at.error + at.share * fine.f_error) / std::max(1e-20F, f.f);
  hits.share[lane] = static_cast<float>(at.share);
  for (std::size_t k = 0; k < 3; ++k) hits.share_gradient[k][lane] = static_cast<float>(at.gradient[k]);
  hits.share_bend[lane] = static_cast<float>(at.bend);
  // What strands give is within 1e-4 at 99 of 100 random places (an estimate); floats are rounded.
  hits.share_error[lane] = static_cast<float>(error + (patched ? 2e-4 : 1e-5));
  hits.share_growth[lane] = patched ? 0.0F : static_cast<float>(6 * degree + 2);
}

// What a lane has to be told of a hit, and what comes of it.
struct Hit {
  const Block& block;
  const Vec3d& position;

  void find_start(const SurfaceLanes& found, std::size_t lane, SurfacePoint& out) const {
    const Vec3d growth{found.growth[0][lane], found.growth[1][lane], found.growth[2][lane]};
    out.normal = normalize(-growth);
    out.outside = position + out.normal * (block.half() * static_cast<double>(found.step[lane]));
  }
};

using PointFields = std::array<PointField, most_together>;

// Those of some hits that lie in one block, which share its level, in its coordinates.
struct HitsOfBlock {
  PlacesInLanes places;
  int count = 0;

  // `lanes_left`: a bit for each of the hits that may be among them.
  HitsOfBlock(const Block& block, std::span<const SurfaceQuery> hits, unsigned lanes_left) {
    for (; lanes_left != 0; lanes_left &= lanes_left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes_left));
      if (hits[lane].block == &block) add(lane, (hits[lane].position - block.center()) / block.half());
    }
  }

  unsigned lanes_of() const { return lanes_of_; }
  // Calls visit(i, lane, place).
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) visit(i, lane_[i], exact_[i]);
  }

 private:
  void add(std::size_t lane, const Vec3d& x) {
    const auto i = static_cast<std::size_t>(count++);
    for (std::size_t k = 0; k < 3; ++k) places.at[k][i] = static_cast<float>(x[k]);
    exact_[i] = x;
    lane_[i] = lane;
    lanes_of_ |= 1U << lane;
  }

  unsigned lanes_of_ = 0;
  std::array<std::size_t, most_together> lane_;
  std::array<Vec3d, most_together> exact_;
};

// Places along the normal of a hit, itself the first, at which the field is asked where bounds about the hit prove no
// step. Between limbs that nearly touch C may fall by s, thousandths, over a distance, while remainders let f grow by
// b = n (n + 1) M2 on the square of it, some tens: they never prove more than s^2 / 4 b, some 1e-8, which is less than
// the sum of the hit itself is off. Sums at places have no remainder.
class PlacesAlong {
 public:
  // `hit` and the distance to the nearest source: in coordinates of the block.
  PlacesAlong(const Vec3d& hit, const UnitVec3& normal, double nearest) {
    add(hit, 0);
    for (float share = shortest_start; share < longest_start; share *= 2) {
      const double step = nearest * static_cast<double>(share);
      const Vec3d place = hit + normal * step;
      if (!is_certified(place, nearest)) break;
      add(place, step);
    }
  }
  const PlacesInLanes& in_lanes() const { return in_lanes_; }
  int count() const { return count_; }
  const Vec3d& operator[](std::size_t i) const { return exact_[i]; }

  // The first step to a place that is proved to be outside, but none past a place that is certainly inside: the margin
  // of a hit is what errors and rounding take; where twice as much is missing C is above 1 by more than that.
  std::optional<double> first_outside(const float (&margin)[lanes]) const {
    const float inside = 2 * std::min(margin[0], 0.0F);
    for (std::size_t i = 1; i < static_cast<std::size_t>(count_) && margin[i] >= inside; ++i)
      if (margin[i] > 0) return step_[i];
    return {};
  }

 private:
  // A block's errors are stated for its cube. Off it by a hundredth of the distance those of Gauss-Legendre rules grow
  // with d^-(n + 2 m + 1), at most 1.7 times (n = 20, m = 16 nodes), those of polynomials at most as T_6(1.005), 1.2
  // times, and margins count errors twice.
  static bool is_certified(const Vec3d& place, double nearest) {
    const double most = 1 + 0.005 * std::min(nearest, 1.0);  // along each axis: together less than 0.01
    for (std::size_t k = 0; k < 3; ++k)
      if (!(std::fabs(place[k]) <= most)) return false;
    return length_squared(place) <= 3;
  }

  void add(const Vec3d& place, double step) {
    const auto i = static_cast<std::size_t>(count_++);
    for (std::size_t k = 0; k < 3; ++k) in_lanes_.at[k][i] = static_cast<float>(place[k]);
    exact_[i] = place;
    step_[i] = step;
  }

  static_assert(longest_start <= shortest_start * (1 << (most_together - 1)), "a lane for the hit and for each step");

  PlacesInLanes in_lanes_;
  int count_ = 0;
  std::array<Vec3d, most_together> exact_;
  std::array<double, most_together> step_;
};

// What is rounded of a place does not lead back to the hit.
double rounding_of(const Vec3d& place) { return 4 * rounding::ulp * max_component(abs(place)); }
bool is_resolved(const Vec3d& hit, const Vec3d& start) {
  const double rounding = rounding_of(hit);
  return length_squared(start - hit) > rounding * rounding;
}

// A place by the exact field, along the normal from the hit itself on, for what bounds do not prove or coordinates not
// resolve: points of cones that are some roundings of their coordinates thick, far from the origin. None where C is not
// below 1 within a way.
std::optional<Vec3d> outside_by_exact_field(const BlendField& field, const Vec3d& hit, const UnitVec3& normal,
                                            double way) {
  constexpr double clearly = 1e-10;  // some hundred times what sums in double round
  std::optional<Vec3d> barely;
  for (double step = 0; step <= way; step = step > 0 ? 2 * step : rounding_of(hit)) {
    const Vec3d place = hit + normal * step;
    const double value = corrected_value(field, place);
    if (value < 1 - clearly) return place;
    if (value < 1 && !barely) barely = place;
    if (step == 0 && hit == Vec3d{}) break;
  }
  return barely;
}

}  // namespace

// How far to go from a hit by the field along its normal, if that proves a step.
std::optional<double> BlendTracer::step_by_places(const SurfaceRule& rule, const SurfaceQuery& hit,
                                                  const UnitVec3& normal, float nearest) const {
  const Block& block = *hit.block;
  const BlockLevel& fine = block.fine();
  const PlacesAlong places((hit.position - block.center()) / block.half(), normal, static_cast<double>(nearest));
  PointFields fields;
  state_->kernels.point_fields(fine.level, rule.degree, places.in_lanes(), places.count(), fields.data());
  SurfaceLanes there;
  for (std::size_t i = 0; i < static_cast<std::size_t>(places.count()); ++i) {
    set(there, i, fields[i], fine);
    if (state_->range) set_share(there, i, block, places[i], fields[i], rule.degree);
  }
  state_->kernels.place_margins(rule, places.count(), there);
  const auto step = places.first_outside(there.margin);
  return step ? std::optional(*step * block.half()) : std::nullopt;
}

// By the sums of the fine level, all places at once; certified as places along the normal are.
std::optional<Vec3d> BlendTracer::inside_beside(const SurfaceQuery& hit, const UnitVec3& normal) const {
  const Block& block = *hit.block;
  const BlockLevel& fine = block.fine();
  const int degree = state_->field.degree;
  const Vec3d at = (hit.position - block.center()) / block.half();
  const UnitVec3 inward = -normal;
  PlacesInLanes here;
  for (std::size_t k = 0; k < 3; ++k) here.at[k][0] = static_cast<float>(at[k]);
  PointFields fields;
  state_->kernels.point_fields(fine.level, degree, here, 1, fields.data());
  const PlacesAlong places(at, inward, static_cast<double>(fields[0].nearest));
  state_->kernels.point_fields(fine.level, degree, places.in_lanes(), places.count(), fields.data());
  for (std::size_t i = 1; i < static_cast<std::size_t>(places.count()); ++i) {
    // Errors count twice, and what is rounded.
    const double f = static_cast<double>(fields[i].f), g = length(vec(fields[i].si_gradient));
    const double off = 2 * fine.f_error + 4e-6 * f, g_off = 2 * fine.gradient_error + 4e-6 * g;
    const Vec3d place = hit.position + inward * (length(places[i] - at) * block.half());
    if (state_->iso.inside(std::max(0.0, f - off), std::max(0.0, g - g_off)) && is_resolved(hit.position, place))
      return place;
  }
  return {};
}

SurfacePoint BlendTracer::surface_at(std::size_t tile, const Vec3d& position) const {
  const CellTree::Cell cell = state_->tree.nearest_cell(tile, position);
  return surface_at(block(*cell.tile, cell.slot), position);
}

SurfacePoint BlendTracer::surface_at(const Block& block, const Vec3d& position) const {
  SurfacePoint found;
  const SurfaceQuery query{&block, position};
  surfaces_at(std::span(&query, 1), std::span(&found, 1));
  return found;
}

void BlendTracer::surfaces_at(std::span<const SurfaceQuery> hits, std::span<SurfacePoint> found) const {
  for (; hits.size() > most_together; hits = hits.subspan(most_together), found = found.subspan(most_together))
    surfaces_at(hits.first(most_together), found);
  const SurfaceRule rule{state_->iso.view(), state_->iso.tables(), state_->field.degree};
  SurfaceLanes side_by_side;
  for (unsigned left = (1U << hits.size()) - 1; left != 0;) {
    const Block& block = *hits[static_cast<std::size_t>(std::countr_zero(left))].block;
    const HitsOfBlock here(block, hits, left);
    left &= ~here.lanes_of();
    const BlockLevel& fine = block.fine();
    const bool knows_around = !state_->range || block.patches() != nullptr;
    PointFields fields;
    state_->kernels.point_fields(fine.level, rule.degree, here.places, here.count, fields.data());
    here.for_each([&](std::size_t i, std::size_t lane, const Vec3d& x) {
      set(side_by_side, lane, fields[i], fine);
      FieldAround& around = found[lane].around;
      around.block = knows_around ? block.view().owner : nullptr;
      for (std::size_t k = 0; k < 3; ++k) around.place[k] = here.places.at[k][i];
      around.field = fields[i];
      if (state_->range) set_share(side_by_side, lane, block, x, fields[i], rule.degree);
    });
  }
  state_->kernels.surface_starts(rule, static_cast<int>(hits.size()), side_by_side);
  for (std::size_t lane = 0; lane < hits.size(); ++lane) {
    Hit{*hits[lane].block, hits[lane].position}.find_start(side_by_side, lane, found[lane]);
    SurfacePoint& at = found[lane];
    const Vec3d& hit = hits[lane].position;
    if (side_by_side.margin[lane] > 0 && is_resolved(hit, at.outside)) continue;
    const float nearest = side_by_side.nearest[lane];
    if (const auto step = step_by_places(rule, hits[lane], at.normal, nearest)) at.outside = hit + at.normal * *step;
    if (is_resolved(hit, at.outside)) continue;
    const double way =
        std::max(static_cast<double>(longest_start * nearest) * hits[lane].block->half(), 16 * rounding_of(hit));
    at.outside = outside_by_exact_field(state_->field, hit, at.normal, way).value_or(hit);
  }
}

}  // namespace marrow
