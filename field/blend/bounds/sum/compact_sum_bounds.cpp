// What primitives under the compact kernel may change by: up to their support, derivatives have no bound of the kind
// that falls with the distance.
#include <algorithm>
#include <cmath>
#include <optional>

#include "field/blend/bounds/sum/compact_steepness.h"
#include "field/blend/bounds/sum/edge_bend.h"
#include "field/blend/bounds/sum/sum_bounds.h"
#include "field/blend/bounds/sum/support_share.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

// How far first derivatives of the kernel change over a scaled step, at most, where m = 3: they are 3/R^2 x sqrt(1-y),
// and roots of numbers that differ by d differ by sqrt(d).
double most_changed(const Profile& profile, const Kernel& kernel, double step) {
  const double R = kernel.shape;
  return profile.degree() != 3 ? inf
                               : 3 / (R * R) / profile.normalisation() * (step + std::sqrt(2 * R * step)) * (1 + 1e-9);
}

// How far second derivatives change over a way, at most: evenly along it, and as a root of it or at once.
struct BendChanges {
  double even = 0, sudden = 0;

  double in_all() const { return even + sudden; }
};

// Of a kernel with m >= 4 over a scaled step, of what either support `held` and where `crossed` of it comes in or goes:
// with w = 1 - y its second derivatives are -a w^(h-1) + b w^(h-2) v v^T, a = 2h/R^2, b = 4h(h-1)/R^4, h = m/2. Over
// the step w changes by 2 step / R; for h = 5/2 its root by the root of that, and for h = 2 w^0 by 1 at the edge.
BendChanges bend_changes(const Profile& profile, const Kernel& kernel, const CompactSteepness& steepness, double step,
                         double held, double crossed) {
  const double R = kernel.shape, h = 0.5 * profile.degree(), by = 2 * step / R;
  if (h >= 3) return {steepness.third() * step * held};
  const double a = 2 * h / (R * R), b = 4 * h * (h - 1) / (R * R * R * R), scale = (1 + 1e-9) / profile.normalisation();
  const double at_edge = h > 2 ? held * std::sqrt(by) : crossed;
  return {scale * held * (a * (h - 1) * by + 2 * b * R * step), scale * b * R * R * at_edge};
}

// A stretch beside a straight skeleton of one radius. Along that, f changes by the kernel at its ends alone: with x the
// scaled distance of an end, y = x^2 / R^2 and h = m/2, its first derivatives are at most 2h/R (1-y)^(h-1), its second
// ones 2h/R^2 (1-y)^(h-1) + 4h(h-1)/R^2 (1-y)^(h-2).
struct Beside {
  double across;
  double ends_bent = 0, ends_J_changes = 0;
};
std::optional<Beside> beside(const SegmentSkeleton& s, const Profile& profile, const Kernel& kernel, const Vec3d& p,
                             const Stretch* stretch) {
  if (stretch == nullptr || s.radius_from != s.radius_to || profile.degree() < 4) return {};
  const Vec3d u = (s.to - s.from) / length(s.to - s.from), &half = stretch->half;
  Beside b{length(half - u * dot(half, u)) + stretch->slack + 1e-15 * length(half)};
  const double R = kernel.shape, h = 0.5 * profile.degree(), tau = s.radius_from;
  for (const Vec3d& end : {s.from, s.to}) {
    const Vec3d to_end = end - p;
    const double way = std::clamp(dot(to_end, half) / length_squared(half), -1.0, 1.0);
    const double nearest = (length(to_end - half * way) - stretch->slack) * (1 - 1e-12) / (R * tau);
    const double within = std::max(0.0, 1 - square(std::max(0.0, nearest)));  // 1 - y
    if (within == 0) continue;
    const double lower = half_power(within, profile.degree() - 4),
                 scale = 2 * h / (R * profile.normalisation() * tau * tau) * (1 + 1e-9);
    b.ends_bent += scale * within * lower;
    b.ends_J_changes += scale / R * (within + 2 * (h - 1)) * lower;
  }
  return b;
}
std::optional<Beside> beside(const auto&, const Profile&, const Kernel&, const Vec3d&, const Stretch*) { return {}; }

SumBounds::Part smooth_part(const SkeletonSample& s, double steepest, double bent, double rho) {
  constexpr double error = SumBounds::compact_error;
  const double steep = std::min(steepest, length(s.gradient) * (1 + error) + error * steepest + bent * rho);
  const double by = steep * rho + error * s.value;
  return {.sample = s, .f = {std::max(0.0, s.value - by), s.value + by}, .steepest = steep, .bent = bent};
}

// What is known of one skeleton, or of a part of it.
struct Changes {
  double steepest = 0, bent = 0;  // of |grad f| and |D^2 f|
  double J = 0, S = 0;            // by which these may differ from those in the middle
  double S_beyond_J = 0;          // from that in the middle with J there
  double radius = 0;

  void add(const Changes& part) {
    steepest += part.steepest;
    bent += part.bent;
    J += part.J;
    S += part.S;
    S_beyond_J += part.S_beyond_J;
    radius = std::max(radius, part.radius);
  }
  void bound_by(const Changes& b) {
    steepest = std::min(steepest, b.steepest);
    bent = std::min(bent, b.bent);
    J = std::min(J, b.J);
    S = std::min(S, b.S);
    S_beyond_J = std::min(S_beyond_J, b.S_beyond_J);
    radius = std::min(radius, b.radius);
  }
};

// The support of a kernel and the ball of `rho` around the middle that is asked for.
struct Asked {
  const Profile& profile;
  const Kernel& kernel;
  Vec3d center;
  double rho, across;
  bool is_along;  // a straight way beside the skeleton

  bool reaches(const auto& s) const { return distance_to(s, center) <= rho + kernel.shape * largest_radius(s); }
};

// What of a skeleton can be in the support at once, where all of it is `near` away at least: of a straight one a chord
// of that ball which does not enter the smaller one, or what is left of it behind that.
double held_of(const auto& s, double reach, double) { return share_within(s, reach); }
double held_of(const SegmentSkeleton& s, double reach, double near) {
  return share_within(s, std::sqrt(std::max(0.0, (reach - near) * (reach + near))) * (1 + 1e-9));
}

// f changes by sup |k'| over the least radius, times the share of the skeleton that the support can hold.
Changes changes_of(const auto& s, const Asked& asked) {
  const auto& [profile, kernel, center, rho, across, is_along] = asked;
  const double reach = kernel.shape * largest_radius(s), least = least_radius(s), largest = largest_radius(s);
  const double near = std::max(0.0, distance_to(s, center) * (1 - 1e-9) - rho);
  const CompactSteepness steepness(profile, kernel.shape, std::max(0.0, 1 - square(near / reach)));
  const double held = held_of(s, reach, near);
  const bool edge = profile.degree() < 4;
  Changes c{
      .steepest = steepness.first() * held / least,
      .bent = edge ? edge_bend(s, profile, kernel.shape, center, rho) : steepness.second() * held / (least * least),
      .J = edge ? edge_bend_change(s, profile, kernel.shape, center, across) : inf,
      .S = most_changed(profile, kernel, rho / least) * held_of(s, reach + rho, near) * (largest / least),
      .S_beyond_J = inf,
      .radius = largest};
  if (edge && c.J < inf) c.S_beyond_J = c.J * across;
  if (edge) return c;
  const bool is_steady = profile.degree() >= 6;  // its second derivatives do not jump at the edge, nor bend there
  const double crossed = is_steady ? 0 : share_crossing(s, center, across, kernel.shape, is_along);
  const BendChanges changes =
      bend_changes(profile, kernel, steepness, across / least, held_of(s, reach + across, near), crossed);
  c.J = changes.in_all() / least;
  c.S_beyond_J = (0.5 * changes.even + changes.sudden) / least * across;
  return c;
}

bool is_nearly_even(const auto& s) { return largest_radius(s) <= 1.3 * least_radius(s); }

// The same from parts whose radii differ less, of which those beyond their own support do not count: together they hold
// no less, but what is thin is not taken for as long, and what is thick not for as steep.
template <class Skeleton>
void add_parts(const Skeleton& s, const Asked& asked, int cuts, Changes& sum) {
  if (!asked.reaches(s)) return;
  if (cuts == 0 || is_nearly_even(s)) {
    sum.add(changes_of(s, asked));
    return;
  }
  for (const Skeleton& part : parts(s)) add_parts(part, asked, cuts - 1, sum);
}

Changes changes_at_most(const auto& s, const Asked& asked) {
  constexpr int most_cuts = 3;
  Changes changes = changes_of(s, asked), by_parts;
  if (is_nearly_even(s)) return changes;
  add_parts(s, asked, most_cuts, by_parts);
  changes.bound_by(by_parts);
  return changes;
}
Changes changes_at_most(const PointSkeleton& s, const Asked& asked) { return changes_of(s, asked); }

}  // namespace

void SumBounds::add_compact(const BlendField& blend) {
  const Kernel kernel = kernel_of(blend);
  const auto all = [&](const auto& skeletons, int dimension, const auto& field) {
    const Profile profile(kernel, dimension);
    for (const auto& s : skeletons) {
      const auto along = beside(s, profile, kernel, center_, stretch());
      const Asked asked{profile, kernel, center_, rho_, along ? along->across : rho_, along.has_value()};
      if (!asked.reaches(s)) {
        keep({.steepest = 0, .bent = 0});
        continue;
      }
      const SkeletonSample sample = field(s);
      const Changes changes = changes_at_most(s, asked);
      if (keeps_parts_) keep(smooth_part(sample, changes.steepest, changes.bent, rho_));
      if (changes.bent < inf) {
        add(sample, Smooth{changes.steepest, changes.bent, changes.radius, asked.across, changes.J, changes.S_beyond_J,
                           along ? along->ends_bent : 0, along ? along->ends_J_changes : 0});
        continue;
      }
      const double f = sample.value, by = changes.steepest * rho_ + compact_error * f;
      const double longest = changes.steepest * changes.radius, S_by = changes.S + compact_error * longest;
      const bool is_near = !(S_by < longest);
      add({.f = {std::max(0.0, f - by), f + by},
           .S = is_near ? Vec3d{} : sample.si_gradient,
           .S_by = std::min(longest, S_by) * (1 + 1e-9),
           .log_slope = inf});
    }
  };
  constexpr auto second = Derivatives::Second;
  const Vec3d& p = center_;
  all(blend.points.skeletons, 0, [&](const PointSkeleton& s) { return point_field<second>(s, p, kernel); });
  all(blend.segments.skeletons, 1, [&](const SegmentSkeleton& s) { return segment_field<second>(s, p, kernel); });
  all(blend.triangles.skeletons, 2, [&](const TriangleSkeleton& s) { return triangle_field<second>(s, p, kernel); });
  all(blend.arcs.skeletons, 1, [&](const ArcSkeleton& s) { return arc_field<second>(s, p, kernel); });
}

}  // namespace marrow
