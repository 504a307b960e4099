// What primitives by distance may change by: they are k(e) of the least scaled distance e, which moves by as much as
// the place does over the radius.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "field/blend/bounds/sum/distances_in_reach.h"
#include "field/blend/bounds/sum/steepest_slope.h"
#include "field/blend/bounds/sum/sum_bounds.h"
#include "field/blend/primitive_visit.h"
#include "field/math/elementary.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

// How far the unit vector from the nearest point of the skeleton turns over rho: level surfaces of e are those of
// convex bodies, flat, round or conical. Seen from the apex of a cone of the slope k, at the angle theta from its axis,
// k e = sin theta and the distance is tan theta times that from the apex, so that the vector turns by tan theta over
// the distance at most. From k e = 1 on the larger end is nearest. Of triangles of several radii and of arcs, whose
// nearest point may jump, slopes tell it.
double turn(const SegmentSkeleton& s, double distance, double rho, const Interval& e) {
  const double slope = std::fabs(s.radius_to - s.radius_from) / length(s.to - s.from),
               round = 2 * rho / (distance - rho);
  if (slope * e.lo > 1) return round;
  return slope * e.hi < 1 ? round / std::sqrt(1 - square(slope * e.hi)) : inf;
}
bool is_even(const TriangleSkeleton& s) { return s.radii[0] == s.radii[1] && s.radii[1] == s.radii[2]; }
bool is_even(const ArcSkeleton&) { return false; }
double turn(const TriangleSkeleton& s, double distance, double rho, const Interval&) {
  return is_even(s) ? 2 * rho / (distance - rho) : inf;
}
double turn(const ArcSkeleton&, double, double, const Interval&) { return inf; }

// Also of numbers that root() does not take.
double any_root(double x, int degree) { return x > 1e-300 && x < 1e300 ? root(x, degree) : pow(x, 1.0 / degree); }

// The scaled distance e where it is off by `moved` at most from where the field is f. The compact kernel tells of it
// within its support only.
Interval scaled_near(const Kernel& kernel, double f, double moved) {
  if (kernel.family == KernelFamily::Inverse) {
    const double e = std::isfinite(f) ? 1 / any_root(f, kernel.degree - 1) : 0, by = moved + 1e-10 * e;
    return {e - by, e + by};
  }
  const Profile profile(kernel, 0);
  const int m = profile.degree();
  const bool is_compact = kernel.family == KernelFamily::Compact;
  const double size = is_compact ? kernel.shape : 1 / kernel.shape;
  // (e / size)^2 from k; a relative 1e-9 of it or of 1 stands for the error of the sample.
  const double ratio = std::min(1.0, f * profile.normalisation());
  const double power = square(any_root(ratio, m)), y = is_compact ? 1 - power : 1 / power - 1;
  return {std::max(0.0, size * std::sqrt(std::max(0.0, y - 1e-9 * (1 + y))) - moved),
          f > 0 ? size * std::sqrt(y + 1e-9 * (1 + y)) + moved : inf};
}

// |k'| between two scaled distances: it rises to the steepest place of the kernel and falls from there on, to 0 at the
// edge of a support.
Interval steepness_between(const Profile& profile, const Kernel& kernel, const Interval& e) {
  const int m = profile.degree();
  const bool is_compact = kernel.family == KernelFamily::Compact;
  const double size = is_compact ? kernel.shape : 1 / kernel.shape;
  const auto slope = [&](double x) {
    if (!(is_compact ? x < size : x < inf)) return 0.0;
    return std::fabs(2 * x * profile.at(x * x).slope) / profile.normalisation();
  };
  const double top = size / std::sqrt(is_compact ? m - 1.0 : m + 1.0), a = slope(e.lo), b = slope(e.hi);
  const bool has_top = e.lo * (1 - 1e-9) <= top && top <= e.hi * (1 + 1e-9);
  const double most = has_top ? steepest(profile, kernel) : std::max(a, b);
  return {std::min(a, b) * (1 - 1e-9), most * (1 + 1e-9)};
}

double largest_size(const Vec3<Interval>& v) {
  return std::sqrt(square(abs(v.x).hi) + square(abs(v.y).hi) + square(abs(v.z).hi)) * (1 + 1e-15);
}

// What slopes tell of f and S, if it is less: they change from the middle by the steepest slope times rho at most.
void narrow(SumBounds::Between& b, const SkeletonSample& middle, const PrimitiveSlopes& slopes, double rho) {
  const double f_by = rho * largest_size(slopes.gradient) * (1 + 1e-9) + 1e-10 * middle.value;
  b.f = {std::max(b.f.lo, middle.value - f_by), std::min(b.f.hi, middle.value + f_by)};
  const double turns = std::sqrt(square(largest_size(slopes.J[0])) + square(largest_size(slopes.J[1])) +
                                 square(largest_size(slopes.J[2])));
  const double S_by = rho * turns * (1 + 1e-9) + 1e-10 * length(middle.si_gradient);
  if (!(S_by < b.S_by)) return;
  b.S = middle.si_gradient;
  b.S_by = S_by;
}

// A primitive in the middle of the box, and its scaled distance from all places that count.
struct Middle {
  SkeletonSample sample;
  double distance;  // not scaled
  Interval scaled;
};
Middle middle_of(const auto& s, const SumBounds& sum, const Kernel& kernel) {
  const SkeletonSample sample = distance_field<Derivatives::First>(s, sum.center(), kernel);
  return {sample, distance_to(s, sum.center()), scaled_near(kernel, sample.value, sum.rho() / least_radius(s))};
}
Middle middle_of(const SegmentSkeleton& s, const SeenSegment& seen, const SumBounds& sum, const Kernel& kernel) {
  const PointSkeleton place{{}, seen.place.radius};
  const Vec3d& v = seen.place.to_point;
  return {kernel.family == KernelFamily::Inverse ? point_field<Derivatives::First>(place, v, kernel.degree)
                                                 : point_field<Derivatives::First>(place, v, kernel),
          s.radius_from == s.radius_to ? length(v) : distance_to(s, sum.center()), seen.scaled};
}

// e = min d / radius changes by rho / radius at most, f = k(e), |S| = |k'(e)|.
template <class Skeleton>
SumBounds::Between distance_bounds(const Skeleton& s, const Middle& middle, const SumBounds& sum,
                                   const Kernel& kernel) {
  const auto& [sample, distance, e] = middle;
  if (kernel.family == KernelFamily::Compact && distance > (sum.rho() + kernel.shape * largest_radius(s)) * (1 + 1e-9))
    return {.f = 0, .log_slope = 0};  // its support is elsewhere
  const double f = sample.value;
  const double turned = distance > sum.rho() ? turn(s, distance, sum.rho(), e) : inf;
  // S between its least and largest length, turned by as much.
  const auto give_S = [&](SumBounds::Between& b, double S_low, double S_high) {
    b.S_by = S_high;
    if (!(turned < 1 && length(sample.si_gradient) > 0)) return;
    b.S = normalize(sample.si_gradient) * (0.5 * (S_low + S_high));
    b.S_by = (0.5 * (S_high - S_low) + S_high * turned) * (1 + 1e-9);
  };
  if (kernel.family != KernelFamily::Inverse) {
    const Profile profile(kernel, 0);
    const Interval lengths = steepness_between(profile, kernel, e);
    const double by = lengths.hi * (sum.rho() / least_radius(s)) * (1 + 1e-9) + 1e-10 * f;
    SumBounds::Between b{.f = {std::max(0.0, f - by), f + by},
                         .log_slope = f > by ? lengths.hi / (least_radius(s) * (f - by)) * (1 + 1e-9) : inf};
    give_S(b, lengths.lo, lengths.hi);
    return b;
  }
  const int n = kernel.degree;
  const auto [near, far] = e;
  if (!(near > 0)) return {.f = {(1 - 1e-10) / integer_power(far, n - 1), inf}, .S_by = inf, .log_slope = inf};
  const double S_high = (n - 1) * (1 + 1e-10) / integer_power(near, n);
  SumBounds::Between b{.f = {(1 - 1e-10) / integer_power(far, n - 1), (1 + 1e-10) / integer_power(near, n - 1)},
                       .S_by = S_high,
                       .log_slope = (n - 1) * (1 + 1e-10) / (near * least_radius(s))};
  give_S(b, (n - 1) * (1 - 1e-10) / integer_power(far, n), S_high);
  return b;
}

double speed_of_place(const ArcSkeleton& s, const Box3& box) { return place_speed(s, box); }
double speed_of_place(const auto&, const Box3&) { return inf; }  // mean_angles.cpp tells it

// The same for means, which ask for |grad f| = |S| / radius.
template <class Skeleton>
SumBounds::Part distance_part(const Skeleton& s, const Middle& middle, const SumBounds::Between& b,
                              const SumBounds& sum) {
  if (b.f.hi == 0) return {.steepest = 0, .bent = 0};
  return {.sample = middle.sample,
          .f = b.f,
          .steepest = (length(b.S) + b.S_by) / least_radius(s) * (1 + 1e-9),
          .scaled = middle.scaled,
          .place_speed = speed_of_place(s, sum.box())};
}

// The skeletons of one strand of which the largest field counts; where several may be that, S is one of theirs.
struct Largest {
  SumBounds::Between bounds;
  std::array<std::size_t, 3> candidates{};
  std::size_t count = 1;  // one more than candidates has room for: not known which

  Largest(const SumBounds::Between& first, std::size_t index) : bounds(first), candidates{index} {}

  void add(const SumBounds::Between& other, std::size_t index) {
    if (other.f.hi < bounds.f.lo || other.f.hi == 0) return;
    if (bounds.f.hi < other.f.lo || bounds.f.hi == 0) {
      *this = {other, index};
      return;
    }
    bounds = {.f = max(bounds.f, other.f),
              .S = (bounds.S + other.S) * 0.5,
              .S_by = 0.5 * length(bounds.S - other.S) + std::max(bounds.S_by, other.S_by) * (1 + 1e-15),
              .log_slope = std::max(bounds.log_slope, other.log_slope)};
    if (count < candidates.size()) candidates[count] = index;
    count = std::min(count + 1, candidates.size() + 1);
  }

  // What slopes there are: where one takes over from another f is continuous, with slopes of either, but S may jump,
  // unless all of them see the same end.
  void give_slopes(const auto& skeletons, const Box3& box, const Kernel& kernel) {
    if (bounds.f.hi == 0) {
      bounds.slopes = PrimitiveSlopes{};
      return;
    }
    if (count > candidates.size()) return;
    std::optional<PrimitiveSlopes> all = distance_slopes(skeletons[candidates[0]], box, kernel);
    for (std::size_t i = 1; i < count && all; ++i) {
      const auto other = distance_slopes(skeletons[candidates[i]], box, kernel);
      if (!other) return;
      if (*other == *all) continue;
      bounds.S_jumps = true;
      for (std::size_t k = 0; k < 3; ++k) all->gradient[k] = hull(all->gradient[k], other->gradient[k]);
    }
    bounds.slopes = all;
  }
};

}  // namespace

// Of a strand only what may be the largest counts; the rest is nothing to means.
void SumBounds::keep_strand(std::size_t size, std::span<const SeenSegment> seen, std::span<const Part> parts) {
  double largest = 0;
  for (const Part& part : parts) largest = std::max(largest, part.f.lo);
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0, k = 0; i < size; ++i) {
    const Part* const part = k < seen.size() && seen[k].index == i ? &parts[k++] : nullptr;
    if (part == nullptr || part->f.hi < largest || part->f.hi == 0) {
      keep({.steepest = 0, .bent = 0});
      continue;
    }
    candidates.push_back(parts_.size());
    keep(*part);
  }
  if (candidates.size() > 1) takeovers_.push_back(std::move(candidates));
}

void SumBounds::add_strands(const BlendField& blend) {
  const Kernel kernel = kernel_of(blend);
  NearestSegments nearest(kernel, {.center = center_, .radius = rho_});
  std::vector<Part> parts;
  for_each_strand(blend.distance_segments, [&](std::size_t, std::span<const SegmentSkeleton> strand) {
    const auto seen = nearest.of(strand);
    parts.clear();
    std::optional<Largest> all;
    for (const SeenSegment& one : seen) {
      const SegmentSkeleton& s = strand[one.index];
      const Middle middle = middle_of(s, one, *this, kernel);
      const Between bounds = distance_bounds(s, middle, *this, kernel);
      if (all) all->add(bounds, one.index);
      else all.emplace(bounds, one.index);
      if (keeps_parts_) parts.push_back(distance_part(s, middle, bounds, *this));
    }
    if (keeps_parts_) keep_strand(strand.size(), seen, parts);
    if (!all) return;
    if (has_gradient()) all->give_slopes(strand, box_, kernel);
    all->bounds.is_on_curve = true;
    add(all->bounds);
  });
}

void SumBounds::add_distances(const BlendField& blend) {
  const Kernel kernel = kernel_of(blend);
  add_strands(blend);
  const auto add_one = [&](const auto& s) {
    const Middle middle = middle_of(s, *this, kernel);
    Between bounds = distance_bounds(s, middle, *this, kernel);
    std::optional<PrimitiveSlopes> slopes;
    if (bounds.f.hi == 0) slopes = PrimitiveSlopes{};
    else if (has_gradient() || !is_even(s)) slopes = distance_slopes(s, box_, kernel);
    if (slopes && bounds.f.hi > 0 && !is_even(s)) narrow(bounds, middle.sample, *slopes, rho_);
    if (keeps_parts_) keep(distance_part(s, middle, bounds, *this));
    if (has_gradient()) bounds.slopes = slopes;
    bounds.is_on_curve = true;
    add(bounds);
  };
  for (const auto& s : blend.distance_triangles.skeletons) add_one(s);
  for (const auto& s : blend.distance_arcs.skeletons) add_one(s);
}

}  // namespace marrow
