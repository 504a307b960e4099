// Arcs, and triangles that are narrow, under the Cauchy kernel by panels, under the compact one by adaptive quadrature.
#include "field/skeleton/even_lines.h"
#include "field/skeleton/skeletons.h"
#include "field/skeleton/surface_integral.h"
#include "field/skeleton/triangle_methods.h"

namespace marrow {

template <Derivatives Order>
SkeletonSample arc_field(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  const Profile profile(kernel, 1);
  return integrate_arc<SkeletonSample>(
      arc, p, kernel, [&](const Vec3d& v, double tau, double, double weight, SkeletonSample& sum) {
        add_source<Order>(profile, v, tau, weight / (profile.normalisation() * tau), sum);
      });
}

template <Derivatives Order>
SkeletonSample triangle_by_lines(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  const Profile profile(kernel, 2);
  const bool has_steep_edge =
      Order >= Derivatives::Second && kernel.family == KernelFamily::Compact && profile.degree() == 2;
  return integrate_triangle<SkeletonSample>(
      triangle, p, kernel,
      [&](const Vec3d& v, double tau, double weight, SkeletonSample& sum) {
        add_source<Order>(profile, v, tau, weight / (profile.normalisation() * tau * tau), sum);
      },
      [&](const Vec3d& v, double tau, double weight, SkeletonSample& sum) {
        if (has_steep_edge) add_steep_edge(profile, kernel.shape, v, tau, weight, sum);
      });
}

template <Derivatives Order>
SkeletonSample triangle_field(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  const auto by_sides = triangle_by_sides<Order>(triangle, p, kernel);
  if (by_sides) return *by_sides;
  const bool is_even = triangle.radii[0] == triangle.radii[1] && triangle.radii[1] == triangle.radii[2];
  const bool has_even_lines = !is_even && kernel.family != KernelFamily::Inverse;
  return has_even_lines ? triangle_by_even_lines<Order>(triangle, p, kernel)
                        : triangle_by_lines<Order>(triangle, p, kernel);
}

template SkeletonSample triangle_by_lines<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample arc_field<Derivatives::ScaleInvariant>(const ArcSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample arc_field<Derivatives::First>(const ArcSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample arc_field<Derivatives::Second>(const ArcSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample triangle_field<Derivatives::ScaleInvariant>(const TriangleSkeleton&, const Vec3d&,
                                                                    const Kernel&);
template SkeletonSample triangle_field<Derivatives::First>(const TriangleSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample triangle_field<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&, const Kernel&);

}  // namespace marrow
