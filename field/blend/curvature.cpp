// Hessians from Jacobians of grad_S f, from integrals, or by differences; curvature from both.
#include "field/blend/curvature.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "field/blend/primitive_visit.h"
#include "field/skeleton/shares.h"

namespace marrow {
namespace {

// Central differences of a gradient with steps h and 2h, combined to fourth order, and made symmetric. h is a
// thousandth of the length over which the field changes by itself: the error of the formula is 1e-12 of the Hessian,
// that of rounding 1e-11.
template <class Gradient>
Matrix3 differences(const Gradient& gradient, double value, const Vec3d& p) {
  const double slope = length(gradient(p));
  if (!(slope > 0) || !std::isfinite(value / slope)) return {};
  const double h = 1e-3 * value / slope;
  std::array<Vec3d, 3> columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto difference = [&](double step) {
      Vec3d a = p, b = p;
      a[axis] += step;
      b[axis] -= step;
      return (gradient(a) - gradient(b)) / (2 * step);
    };
    columns[axis] = (difference(h) * 4.0 - difference(2 * h)) / 3;
  }
  Matrix3 symmetric;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) symmetric.rows[i][k] = (columns[k][i] + columns[i][k]) / 2;
  return symmetric;
}

// The one radius of a skeleton, or 0 when it varies.
double constant_radius(const PointSkeleton& s) { return s.radius; }
double constant_radius(const SegmentSkeleton& s) { return s.radius_from == s.radius_to ? s.radius_from : 0; }
double constant_radius(const ArcSkeleton& s) { return s.radius_from == s.radius_to ? s.radius_from : 0; }
double constant_radius(const TriangleSkeleton& s) {
  return s.radii[0] == s.radii[1] && s.radii[0] == s.radii[2] ? s.radii[0] : 0;
}

// One primitive as a blend of its own, in the list that it came from.
template <class Skeleton>
BlendField alone(const BlendField& blend, PrimitiveList<Skeleton> BlendField::*list, const Skeleton& skeleton) {
  BlendField one;
  one.degree = blend.degree;
  one.kernel = blend.kernel;
  one.kernel_shape = blend.kernel_shape;
  (one.*list).skeletons = {skeleton};
  return one;
}

template <class Skeleton>
Matrix3 hessian_of(const BlendField& blend, PrimitiveList<Skeleton> BlendField::*list, const Skeleton& skeleton,
                   const Vec3d& p) {
  const BlendField one = alone(blend, list, skeleton);
  const SkeletonSample s = sum_of_primitives<Derivatives::Second>(one, p);
  if (!(s.value > 0 && s.value <= field_ceiling)) return {};
  if (const double radius = constant_radius(skeleton); radius > 0) return s.si_jacobian * (1 / radius);
  const auto gradient = [&](const Vec3d& q) { return sum_of_primitives<Derivatives::First>(one, q).gradient; };
  return differences(gradient, s.value, p);
}

Matrix3 hessian_of(const BlendField& blend, PrimitiveList<SegmentSkeleton> BlendField::*list,
                   const SegmentSkeleton& segment, const Vec3d& p) {
  if (list == &BlendField::segments) {
    const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
    return segment_hessian(segment, p, kernel);
  }
  return hessian_of<SegmentSkeleton>(blend, list, segment, p);
}

}  // namespace

Matrix3 sum_hessian(const BlendField& blend, const Vec3d& p) {
  const SkeletonSample all = sum_of_primitives<Derivatives::First>(blend, p);
  if (!(all.value > 0 && all.value <= field_ceiling)) return {};
  Matrix3 sum;
  const auto add = [&](auto list) {
    for (const auto& skeleton : (blend.*list).skeletons) sum += hessian_of(blend, list, skeleton, p);
  };
  add(&BlendField::points);
  add(&BlendField::segments);
  add(&BlendField::cani_hornus_segments);
  add(&BlendField::triangles);
  add(&BlendField::distance_triangles);
  add(&BlendField::arcs);
  add(&BlendField::distance_arcs);
  // of a strand of distance segments the nearest counts, also under small steps
  const Kernel kernel{blend.kernel, blend.degree, blend.kernel_shape};
  visit_strands(
      blend.distance_segments,
      [&](const SegmentSkeleton& s) { return distance_field<Derivatives::First>(s, p, kernel); },
      [&](const SkeletonSample&, const auto& list, std::size_t i) {
        sum += hessian_of(blend, &BlendField::distance_segments, list.skeletons[i], p);
      });
  return sum;
}

Matrix3 corrected_hessian(const BlendField& blend, const Vec3d& p) {
  const double value = corrected_value(blend, p);
  if (!(value > 0 && value <= field_ceiling)) return {};
  return differences([&](const Vec3d& q) { return evaluate(blend, q).corrected_gradient; }, value, p);
}

// With the outward normal n = -g / |g|: mean = div n / 2, and the Gaussian one from the adjugate of the Hessian.
Curvature curvature_of(const Vec3d& g, const Matrix3& hessian) {
  const double slope = length(g);
  if (!(slope > 0)) return {};
  const Vec3d n = g / slope;
  const auto& [x, y, z] = hessian.rows;
  const Vec3d bent = hessian.times(n);
  const double trace = x.x + y.y + z.z;
  const Vec3d adjugate_n = cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
  return {.mean = (dot(n, bent) - trace) / (2 * slope), .gaussian = dot(n, adjugate_n) / (slope * slope)};
}

}  // namespace marrow
