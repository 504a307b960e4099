#include "field/skeleton/even_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "field/skeleton/compact_chord.h"
#include "field/skeleton/moment_sample.h"
#include "field/skeleton/surface_integral.h"

namespace marrow {
namespace {

// Two triangles, cut along the line through the corner of the middle radius on which the radius is that: it is the
// base of both, and all lines parallel to it have one radius.
struct EvenCut {
  Vec3d middle, normal;  // that corner; of the whole triangle, as little may be left of a part
  UnitVec3 u;            // along the base, from the corner
  double base, radius;
  std::array<std::size_t, 2> apexes;

  explicit EvenCut(const TriangleSkeleton& t) {
    std::array<std::size_t, 3> by{0, 1, 2};
    std::sort(by.begin(), by.end(), [&](std::size_t a, std::size_t b) { return t.radii[a] < t.radii[b]; });
    radius = t.radii[by[1]];
    middle = t.vertices[by[1]];
    apexes = {by[0], by[2]};
    const auto& v = t.vertices;
    const double thin = t.radii[by[0]], thick = t.radii[by[2]];
    // To the other end of that line: from differences, so that places lose no digits far out.
    const Vec3d along = lerp(v[by[0]] - middle, v[by[2]] - middle, (radius - thin) / (thick - thin));
    normal = normalize(cross(v[1] - v[0], v[2] - v[0])).vec();
    const Vec3d in_plane = along - normal * dot(along, normal);
    base = length(in_plane);
    u = UnitVec3::unchecked(in_plane / base);
  }

  TriangleView view(const TriangleSkeleton& t, std::size_t apex, const Vec3d& p) const {
    const Vec3d side = t.vertices[apex] - middle, from_middle = p - middle, w = cross(normal, u.vec());
    const double turn = dot(side, w) < 0 ? -1 : 1;
    const UnitVec3 up = UnitVec3::unchecked(w * turn), out = UnitVec3::unchecked(normal * turn);
    return {.u = u,
            .w = up,
            .normal = out,
            .base = base,
            .apex_u = dot(side, u),
            .apex_w = dot(side, up),
            .p_u = dot(from_middle, u),
            .p_w = dot(from_middle, up),
            .p_normal = dot(from_middle, out),
            .radius_begin = radius,
            .radius_end = radius,
            .radius_apex = t.radii[apex]};
  }
};

// A line of a view at the height x over its foot.
struct EvenLine {
  Line line;
  UnitVec3 u;
  Vec3d across;

  EvenLine(const TriangleView& view, double x) : u(view.u), across(view.normal * view.p_normal - view.w * x) {
    const SegmentView seen = line_at(view, x);
    line = {seen.t1, seen.t2, seen.h_squared, seen.radius1, 0};
  }
  bool is_empty() const { return !(line.t1 < line.t2); }
};

template <Derivatives Order>
SkeletonSample compact_part(const TriangleView& view, const Kernel& kernel, const Profile& profile) {
  const CompactChords chords(kernel, 2);
  const bool has_steep_edge = Order >= Derivatives::Second && profile.degree() == 2;
  const auto add_line = [&](double x, double weight, SkeletonSample& sum) {
    const EvenLine at(view, x);
    const double tau = at.line.at_foot;
    if (at.is_empty()) return;
    chords.add<Order>(at.line, at.across, at.u, weight / (tau * tau), sum);
    if (!has_steep_edge) return;
    for_each_edge(at.line, kernel.shape, [&](double t, double steepness) {
      add_steep_edge(profile, kernel.shape, at.across - at.u * t, tau, weight / steepness, sum);
    });
  };
  return surface_integral::integrate_compact_lines<SkeletonSample>(view, kernel, add_line);
}

// (1 + s^2 d^2 / tau^2)^(-m/2) is (s / tau)^-m times a power of the distance from tau / s higher up: with that as the
// radius moments are of numbers near 1, whatever the units.
template <Derivatives Order>
SkeletonSample cauchy_part(const TriangleView& view, const Kernel& kernel, const Profile& profile) {
  const int m = profile.degree();
  const auto add_line = [&](double x, double weight, SkeletonSample& sum) {
    const EvenLine at(view, x);
    const double tau = at.line.at_foot, up = tau / kernel.shape;
    if (at.is_empty()) return;
    const SegmentView lifted{.t1 = at.line.t1,
                             .t2 = at.line.t2,
                             .h_squared = at.line.h_squared + up * up,
                             .slope = 0,
                             .radius1 = up,
                             .radius_at_foot = up};
    const double scale = weight * up / (profile.normalisation() * tau * tau);
    SkeletonSample part = sample_of<Order>(segment_moments<Order>(lifted, m), at.u, at.across, m, scale);
    part.si_gradient = part.si_gradient * kernel.shape;
    part.si_jacobian = part.si_jacobian * kernel.shape;
    sum += part;
  };
  return surface_integral::integrate_cauchy_lines<SkeletonSample>(view, kernel, add_line);
}

}  // namespace

template <Derivatives Order>
SkeletonSample triangle_by_even_lines(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  const Profile profile(kernel, 2);
  const EvenCut cut(triangle);
  SkeletonSample sum;
  for (const std::size_t apex : cut.apexes) {
    const TriangleView view = cut.view(triangle, apex, p);
    if (!(view.apex_w > 0)) continue;
    sum += kernel.family == KernelFamily::Compact ? compact_part<Order>(view, kernel, profile)
                                                  : cauchy_part<Order>(view, kernel, profile);
  }
  return sum;
}

template SkeletonSample triangle_by_even_lines<Derivatives::ScaleInvariant>(const TriangleSkeleton&, const Vec3d&,
                                                                            const Kernel&);
template SkeletonSample triangle_by_even_lines<Derivatives::First>(const TriangleSkeleton&, const Vec3d&,
                                                                   const Kernel&);
template SkeletonSample triangle_by_even_lines<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&,
                                                                    const Kernel&);

}  // namespace marrow
