// What primitives under the compact kernel may change by: up to their support, derivatives have no bound of the kind
// that falls with the distance.
#include <algorithm>
#include <cmath>

#include "field/blend/steepest_slope.h"
#include "field/blend/sum_bounds.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

// What a primitive can hold of its skeleton within a distance, over a radius to the power of its dimension.
double share(const PointSkeleton&, double) { return 1; }
double share(const SegmentSkeleton& s, double reach) {
  return std::min(length(s.to - s.from), 2 * reach) / least_radius(s);
}
double share(const ArcSkeleton& s, double) { return s.major * (s.end - s.begin) / least_radius(s); }
double share(const TriangleSkeleton& s, double reach) {
  const double area = 0.5 * length(cross(s.vertices[1] - s.vertices[0], s.vertices[2] - s.vertices[0]));
  return std::min(area, 3.2 * reach * reach) / (least_radius(s) * least_radius(s));
}

// sup of the second derivatives, over the scaled position, of the normalised compact kernel (1 - x^2/R^2)^h, h = m/2:
// its derivatives along and across are -2h/R^2 (1-y)^(h-1) and that plus 4h(h-1)/R^2 y (1-y)^(h-2), y = x^2/R^2 <= 1.
double most_bent(const Profile& profile, const Kernel& kernel) {
  const double m = profile.degree();
  return m < 4 ? inf : m * (m - 2) / (kernel.shape * kernel.shape) / profile.normalisation() * (1 + 1e-9);
}

// The same times what the support holds of a skeleton. For m = 3 second derivatives are at most 3/R^2 (1-y)^(-1/2), and
// along a segment R^2 r^2 (1-y) is a parabola, so that the integral from root to root is finite: that of
// R r / sqrt(Q), Q = (1 - R^2 r'^2) (L^2 - s^2), is at most pi R r / sqrt(1 - R^2 r'^2).
double held_bend(const Profile& profile, const Kernel& kernel, const auto&, double held) {
  return most_bent(profile, kernel) * held;
}
double held_bend(const Profile& profile, const Kernel& kernel, const SegmentSkeleton& s, double held) {
  if (profile.degree() != 3) return most_bent(profile, kernel) * held;
  const double R = kernel.shape, slope = (s.radius_to - s.radius_from) / length(s.to - s.from);
  const double open = 1 - square(R * slope);
  if (!(open > 0)) return inf;
  const double chord = 3.1415927 * R * largest_radius(s) / (least_radius(s) * std::sqrt(open));
  return 3 / (R * R) / profile.normalisation() * chord * (1 + 1e-9);
}

// How far first derivatives of the kernel change over a scaled step, at most, where m = 3: they are 3/R^2 x sqrt(1-y),
// and roots of numbers that differ by d differ by sqrt(d).
double most_changed(const Profile& profile, const Kernel& kernel, double step) {
  const double R = kernel.shape;
  return profile.degree() != 3 ? inf
                               : 3 / (R * R) / profile.normalisation() * (step + std::sqrt(2 * R * step)) * (1 + 1e-9);
}

}  // namespace

// f changes by rho sup |k'| times the share of the skeleton that the support can hold.
void SumBounds::add_compact(const BlendField& blend) {
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  const auto all = [&](const auto& skeletons, int dimension, const auto& field) {
    const Profile profile(kernel, dimension);
    const double steep = steepest(profile, kernel);
    for (const auto& s : skeletons) {
      const double reach = kernel.shape * largest_radius(s);
      if (distance_to(s, center_) > rho_ + reach) continue;
      const SkeletonSample sample = field(s);
      const double held = share(s, reach), least = least_radius(s), largest = largest_radius(s);
      const double per_length = steep * held / least * (1 + 1e-9);
      if (const double bend = held_bend(profile, kernel, s, held); bend < inf) {
        add(sample, Smooth{per_length, bend / (least * least), largest});
        continue;
      }
      const double f = sample.value, by = per_length * rho_ + compact_error * f, longest = per_length * largest;
      const double S_by =
          most_changed(profile, kernel, rho_ / least) * held * (largest / least) + compact_error * longest;
      const bool is_near = !(S_by < longest);
      add({.f = {std::max(0.0, f - by), f + by},
           .S = is_near ? Vec3d{} : sample.si_gradient,
           .S_by = std::min(longest, S_by) * (1 + 1e-9),
           .log_slope = inf});
    }
  };
  constexpr auto value = Derivatives::First;
  const Vec3d& p = center_;
  all(blend.points.skeletons, 0, [&](const PointSkeleton& s) { return point_field<value>(s, p, kernel); });
  all(blend.segments.skeletons, 1, [&](const SegmentSkeleton& s) { return segment_field<value>(s, p, kernel); });
  all(blend.triangles.skeletons, 2, [&](const TriangleSkeleton& s) { return triangle_field<value>(s, p, kernel); });
  all(blend.arcs.skeletons, 1, [&](const ArcSkeleton& s) { return arc_field<value>(s, p, kernel); });
}

}  // namespace marrow
