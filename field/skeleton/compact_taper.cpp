#include "field/skeleton/compact_taper.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "field/skeleton/compact_chord.h"
#include "field/skeleton/surface_integral.h"

namespace marrow {
namespace {

// Two triangles, cut along the line through the corner of the middle radius on which the radius is that: it is the
// base of both, and all lines parallel to it have one radius.
struct EvenCut {
  Vec3d middle, cut;
  double radius;
  std::array<std::size_t, 2> apexes;

  explicit EvenCut(const TriangleSkeleton& t) {
    std::array<std::size_t, 3> by{0, 1, 2};
    std::sort(by.begin(), by.end(), [&](std::size_t a, std::size_t b) { return t.radii[a] < t.radii[b]; });
    radius = t.radii[by[1]];
    middle = t.vertices[by[1]];
    apexes = {by[0], by[2]};
    const double thin = t.radii[by[0]], thick = t.radii[by[2]];
    cut = lerp(t.vertices[by[0]], t.vertices[by[2]], (radius - thin) / (thick - thin));
  }

  // With the normal of the whole triangle, as little may be left of a part.
  TriangleView view(const TriangleSkeleton& t, std::size_t apex, const Vec3d& p) const {
    const auto& v = t.vertices;
    const Vec3d side = v[apex] - middle, from_middle = p - middle;
    const double base = length(cut - middle);
    const UnitVec3 u = UnitVec3::unchecked((cut - middle) / base);
    const Vec3d normal = normalize(cross(v[1] - v[0], v[2] - v[0])).vec(), w = cross(normal, u.vec());
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

}  // namespace

template <Derivatives Order>
SkeletonSample compact_taper_field(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  const Profile profile(kernel, 2);
  const CompactChords chords(kernel, 2);
  const bool has_steep_edge = Order >= Derivatives::Second && profile.degree() == 2;
  SkeletonSample sum;
  const EvenCut cut(triangle);
  for (const std::size_t apex : cut.apexes) {
    const TriangleView view = cut.view(triangle, apex, p);
    if (!(view.apex_w > 0)) continue;
    const auto add_line = [&](double x, double weight, SkeletonSample& all) {
      const SegmentView seen = line_at(view, x);
      const double tau = seen.radius1;
      const Line line{seen.t1, seen.t2, seen.h_squared, tau, 0};
      if (!(line.t1 < line.t2)) return;
      const Vec3d across = view.normal * view.p_normal - view.w * x;
      chords.add<Order>(line, across, view.u, weight / (tau * tau), all);
      if (!has_steep_edge) return;
      for_each_edge(line, kernel.shape, [&](double t, double steepness) {
        add_steep_edge(profile, kernel.shape, across - view.u * t, tau, weight / steepness, all);
      });
    };
    sum += surface_integral::integrate_compact_lines<SkeletonSample>(view, kernel, add_line);
  }
  return sum;
}

template SkeletonSample compact_taper_field<Derivatives::ScaleInvariant>(const TriangleSkeleton&, const Vec3d&,
                                                                         const Kernel&);
template SkeletonSample compact_taper_field<Derivatives::First>(const TriangleSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample compact_taper_field<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&, const Kernel&);

}  // namespace marrow
