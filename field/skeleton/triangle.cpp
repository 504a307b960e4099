// Field of a triangle of linear radius: Gauss-Legendre over lines parallel to a side, each line in closed form.
#include <array>
#include <cmath>
#include <cstddef>

#include "field/kernel/inverse_family.h"
#include "field/kernel/panels.h"
#include "field/skeleton/moment_sample.h"
#include "field/skeleton/skeletons.h"
#include "field/skeleton/triangle_methods.h"
#include "field/skeleton/triangle_view.h"

namespace marrow {

template <Derivatives Order>
SkeletonSample triangle_by_lines(const TriangleSkeleton& triangle, const Vec3d& p, int n) {
  bool foot_is_inside = false;
  const TriangleView v = best_view(triangle, p, foot_is_inside);
  if (!(v.apex_w > 0)) return {};
  if (foot_is_inside && v.p_normal == 0) return SkeletonSample::on_skeleton();
  const std::array<Singularity, 3> singularities{Singularity{0, std::fabs(v.p_normal)}, of_side(v, 0),
                                                 of_side(v, v.base)};
  const bool is_even = v.radius_begin == v.radius_end && v.radius_begin == v.radius_apex;
  const double scale = 1 / surface_normalisation(n);
  const int degree = kernel_degree(n, 2);
  SkeletonSample sum;
  for_each_panel(-v.p_w, v.apex_w - v.p_w, singularities, v.apex_w, [&](const Panel& panel) {
    for_each_node(panel, is_even ? 0 : n, [&](double x, double weight) {
      const Vec3d across = v.normal * v.p_normal - v.w * x;
      const SegmentMoments moments = segment_moments<Order>(line_at(v, x), degree, 2);
      sum += sample_of<Order>(moments, v.u, across, degree, scale * weight);
    });
  });
  return sum.value <= field_ceiling ? sum : SkeletonSample::on_skeleton();
}

template <Derivatives Order>
SkeletonSample triangle_field(const TriangleSkeleton& triangle, const Vec3d& p, int n) {
  const auto by_sides = triangle_by_sides<Order>(triangle, p, n);
  return by_sides ? *by_sides : triangle_by_lines<Order>(triangle, p, n);
}

template SkeletonSample triangle_by_lines<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&, int);
template SkeletonSample triangle_field<Derivatives::ScaleInvariant>(const TriangleSkeleton&, const Vec3d&, int);
template SkeletonSample triangle_field<Derivatives::First>(const TriangleSkeleton&, const Vec3d&, int);
template SkeletonSample triangle_field<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&, int);

}  // namespace marrow
