// Field of a triangle of one radius: integrals along its sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "field/kernel/inverse_family.h"
#include "field/kernel/panels.h"
#include "field/kernel/segment_moments.h"
#include "field/math/elementary.h"
#include "field/skeleton/triangle_methods.h"

namespace marrow {
namespace {

// All lengths in radii, places from the foot of p in the plane of the triangle.
struct Side {
  Vec3d along, out;  // unit vectors in the plane; `out` away from the triangle
  double t1, t2;     // its ends along its line, from the foot on that line
  double inside;     // how far the foot is from the line, on the side of the triangle
};

struct Plate {
  Vec3d normal;
  double height = 0;  // of p, along the normal
  std::array<Side, 3> sides;
  double narrowest = 0;  // the least height of a corner over its opposite side
  double beside = 0;     // from the foot to the triangle, 0 in it
};

double distance_from_foot(const Side& e) {
  const double beyond = std::max({0.0, e.t1, -e.t2});
  return std::sqrt(beyond * beyond + e.inside * e.inside);
}

// Nothing for a triangle without area.
std::optional<Plate> plate_seen_from(const TriangleSkeleton& t, const Vec3d& p) {
  std::array<Vec3d, 3> v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = (t.vertices[i] - p) / t.radii[0];
  const Vec3d area = cross(v[1] - v[0], v[2] - v[0]);
  const double twice_area = length(area);
  if (!(twice_area > 0)) return {};
  Plate plate{.normal = area / twice_area};
  plate.height = -dot(v[0], plate.normal);
  double longest = 0, nearest = std::numeric_limits<double>::infinity();
  bool foot_is_inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d &a = v[i], &b = v[(i + 1) % 3];
    const double size = length(b - a);
    const Vec3d along = (b - a) / size, out = cross(along, plate.normal);
    plate.sides[i] = {along, out, dot(a, along), dot(b, along), dot(a, out)};
    longest = std::max(longest, size);
    nearest = std::min(nearest, distance_from_foot(plate.sides[i]));
    foot_is_inside = foot_is_inside && plate.sides[i].inside >= 0;
  }
  plate.narrowest = twice_area / longest;
  plate.beside = foot_is_inside ? 0 : nearest;
  return plate;
}

// I(m), I(m+2), I(m+4), where I(m) is the integral of d^-m over the plate.
using PlateIntegrals = std::array<double, 3>;

// In polar coordinates about the foot the integral over the distance from it is (h^-q - d^-q) / q, q = m - 2 and d taken
// on the border, so that I(m) = 1/q sum over sides of e int (h^-q - d^-q) / (t^2 + e^2) dt, with e for `inside`. The
// fraction is h^-q d^-2 (1 - x^(q/2)) / (1 - x), x = h^2 / d^2: a sum of powers of x, all positive.
void add_above(const Side& e, double height, int q, PlateIntegrals& sum) {
  const double h2 = height * height, flat = e.inside * e.inside + h2;
  const Singularity pole{0, std::sqrt(flat)};
  for_each_panel(e.t1, e.t2, {&pole, 1}, e.t2 - e.t1, [&](const Panel& panel) {
    for_each_node(panel, 0, [&](double t, double weight) {
      const double inverse = 1 / (t * t + flat), x = h2 * inverse, factor = e.inside * weight * inverse;
      double powers = 0, last = 1;
      for (int k = 0; k < q / 2; ++k, last *= x) powers += last;
      const double half = q % 2 == 0 ? 0 : 1 / (1 + std::sqrt(x));
      for (double& s : sum) {
        s += factor * (powers + last * half);
        powers += last;
        last *= x;
      }
    });
  });
}

// From outside the constant h^-q of all sides adds up to nothing, and may be left out.
void add_beside(const Side& e, double height, int q, PlateIntegrals& sum) {
  if (e.inside == 0) return;
  const double e2 = e.inside * e.inside, h2 = height * height;
  const Singularity pole{0, std::fabs(e.inside)};
  for_each_panel(e.t1, e.t2, {&pole, 1}, e.t2 - e.t1, [&](const Panel& panel) {
    for_each_node(panel, 0, [&](double t, double weight) {
      const double flat = t * t + e2, inverse = 1 / (flat + h2);
      double power = half_power(inverse, q) * (e.inside * weight / flat);
      for (double& s : sum) {
        s -= power;
        power *= inverse;
      }
    });
  });
}

// Where the foot is less than half the height beside the plate h^-q is no more than 1.25^(q/2) of d^-q at the nearest
// place: sides cancel by that alone.
PlateIntegrals plate_integrals(const Plate& plate, int m) {
  const int q = m - 2;
  PlateIntegrals sum{};
  const bool is_above = 2 * plate.beside <= std::fabs(plate.height);
  for (const Side& e : plate.sides)
    if (is_above) add_above(e, plate.height, q, sum);
    else add_beside(e, plate.height, q, sum);
  double scale = is_above ? 1 / integer_power(std::fabs(plate.height), q) : 1;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    sum[k] *= scale / (q + 2 * static_cast<int>(k));
    if (is_above) scale /= plate.height * plate.height;
  }
  return sum;
}

}  // namespace

// In the plane I(m) changes as the border passes over d^-m: its gradient there is -sum out int d^-m dt.
template <Derivatives Order>
std::optional<SkeletonSample> triangle_by_sides(const TriangleSkeleton& triangle, const Vec3d& p, int n) {
  const double radius = triangle.radii[0];
  if (triangle.radii[1] != radius || triangle.radii[2] != radius) return {};
  const auto plate = plate_seen_from(triangle, p);
  if (!plate) return {};
  const double h = plate->height;
  if (!(plate->beside * plate->beside + h * h <= plate->narrowest * plate->narrowest)) return {};
  if (plate->beside == 0 && h == 0) return SkeletonSample::on_skeleton();
  const int m = kernel_degree(n, 2);
  const double scale = 1 / surface_normalisation(n);
  const PlateIntegrals I = plate_integrals(*plate, m);
  SkeletonSample sum;
  sum.value = scale * I[0];
  if (!(sum.value <= field_ceiling)) return SkeletonSample::on_skeleton();
  sum.si_gradient = plate->normal * (-m * scale * h * I[1]);
  if constexpr (Order >= Derivatives::Second)
    sum.si_jacobian =
        Matrix3::outer(plate->normal, plate->normal) * (m * scale / radius * ((m + 2) * h * h * I[2] - I[1]));
  for (const Side& e : plate->sides) {
    const SegmentView line{.t1 = e.t1,
                           .t2 = e.t2,
                           .h_squared = e.inside * e.inside + h * h,
                           .slope = 0,
                           .radius1 = 1,
                           .radius_at_foot = 1};
    const SegmentMoments moments = segment_moments<Derivatives::First>(line, m);
    sum.si_gradient -= e.out * (scale * moments.value);
    if constexpr (Order >= Derivatives::Second) {
      const Vec3d in_plane = e.out * (e.inside * moments.first[0]) + e.along * moments.first[1];
      const Vec3d mixed = plate->normal * (h * moments.first[0]);
      const double by = m * scale / radius;
      sum.si_jacobian += Matrix3::outer(e.out, (mixed - in_plane) * by) + Matrix3::outer(mixed * by, e.out);
    }
  }
  if constexpr (Order >= Derivatives::First) sum.gradient = sum.si_gradient / radius;
  return sum;
}

template std::optional<SkeletonSample> triangle_by_sides<Derivatives::ScaleInvariant>(const TriangleSkeleton&,
                                                                                      const Vec3d&, int);
template std::optional<SkeletonSample> triangle_by_sides<Derivatives::First>(const TriangleSkeleton&, const Vec3d&,
                                                                             int);
template std::optional<SkeletonSample> triangle_by_sides<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&,
                                                                              int);

}  // namespace marrow
