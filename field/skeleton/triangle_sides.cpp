// Field of a triangle by integrals along its sides: of one radius under any kernel.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "field/kernel/inverse_family.h"
#include "field/kernel/profile.h"
#include "field/kernel/segment_moments.h"
#include "field/math/elementary.h"
#include "field/skeleton/border_terms.h"
#include "field/skeleton/compact_plate.h"
#include "field/skeleton/plate.h"
#include "field/skeleton/tapered_plate.h"
#include "field/skeleton/triangle_methods.h"

namespace marrow {
namespace {

using Side = Plate::Side;

// I(m), I(m+2), I(m+4), where I(m) is the integral of d^-m over the plate.
using PlateIntegrals = std::array<double, 3>;

void add_from_foot(const Plate& plate, const Side& side, int q, PlateIntegrals& sum) {
  const double h2 = plate.height * plate.height, flat = side.inside * side.inside + h2;
  plate.for_each_node_of(side, 0, [&](double t, double weight) {
    const double inverse = 1 / (t * t + flat);
    add_terms_from_foot(h2 * inverse, side.inside * weight * inverse, q, sum);
  });
}

void add_from_border(const Plate& plate, const Side& side, int q, PlateIntegrals& sum) {
  if (side.inside == 0) return;
  const double e2 = side.inside * side.inside, h2 = plate.height * plate.height;
  plate.for_each_node_of(side, 0, [&](double t, double weight) {
    const double flat = t * t + e2;
    add_terms_of_border(1 / (flat + h2), side.inside * weight / flat, q, sum);
  });
}

// A kernel scale d^-m, with the height of the plate counted into d.
struct Power {
  int m;
  double scale;
};

PlateIntegrals plate_integrals(const Plate& plate, int m) {
  const int q = m - 2;
  const bool from_foot = plate.counts_from_foot();
  PlateIntegrals sum{};
  for (const Side& side : plate.sides)
    if (from_foot) add_from_foot(plate, side, q, sum);
    else add_from_border(plate, side, q, sum);
  double scale = from_foot ? 1 / integer_power(std::fabs(plate.height), q) : 1;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    sum[k] *= scale / (q + 2 * static_cast<int>(k));
    if (from_foot) scale /= plate.height * plate.height;
  }
  return sum;
}

// In the plane I(m) changes as the border passes over d^-m: its gradient there is -sum out int d^-m dt. The plate
// stands at the height that counts, the point at h.
template <Derivatives Order>
SkeletonSample even_plate_field(const Plate& plate, const Power& power, double h) {
  const auto [m, scale] = power;
  const PlateIntegrals I = plate_integrals(plate, m);
  SkeletonSample sum;
  sum.value = scale * I[0];
  if (!(sum.value <= field_ceiling)) return SkeletonSample::on_skeleton();
  const double bend = m * scale / plate.unit;
  sum.si_gradient = plate.normal * (-m * scale * h * I[1]);
  if constexpr (Order >= Derivatives::Second)
    sum.si_jacobian = Matrix3::outer(plate.normal, plate.normal) * (bend * ((m + 2) * h * h * I[2] - I[1]));
  for (const Side& side : plate.sides) {
    const SegmentView line{.t1 = side.t1,
                           .t2 = side.t2,
                           .h_squared = side.inside * side.inside + plate.height * plate.height,
                           .slope = 0,
                           .radius1 = 1,
                           .radius_at_foot = 1};
    const SegmentMoments moments = segment_moments<Derivatives::First>(line, m);
    sum.si_gradient -= side.out * (scale * moments.value);
    if constexpr (Order >= Derivatives::Second) {
      const Vec3d in_plane = side.out * (side.inside * moments.first[0]) + side.along * moments.first[1];
      const Vec3d across = plate.normal * (h * moments.first[0]);
      sum.si_jacobian += Matrix3::outer(side.out, (across - in_plane) * bend) + Matrix3::outer(across * bend, side.out);
    }
  }
  if constexpr (Order >= Derivatives::First) sum.gradient = sum.si_gradient / plate.unit;
  return sum;
}

// Sides as seen from p are known to some 2^-50 of the longest. As near as that to a vertex, what they give would cancel
// to anything, of either sign.
bool is_on(const Plate& plate) {
  double longest = 0;
  for (const Side& side : plate.sides) longest = std::max(longest, side.t2 - side.t1);
  return std::hypot(plate.beside, plate.height) <= 0x1p-46 * longest;
}

}  // namespace

template <Derivatives Order>
std::optional<SkeletonSample> triangle_by_sides(const TriangleSkeleton& triangle, const Vec3d& p, int n) {
  const auto plate = plate_seen_from(triangle, p);
  if (!plate) return {};
  const double h = plate->height, beside = plate->beside;
  if (!(beside * beside + h * h <= plate->narrowest * plate->narrowest)) return {};
  if (is_on(*plate)) return SkeletonSample::on_skeleton();
  if (!plate->is_even()) return tapered_plate_field<Order>(*plate, n);
  return even_plate_field<Order>(*plate, {kernel_degree(n, 2), 1 / surface_normalisation(n)}, h);
}

// The Cauchy kernel (1 + s^2 d^2)^(-m/2) is s^-m times a power of the distance from 1/s higher up.
template <Derivatives Order>
std::optional<SkeletonSample> triangle_by_sides(const TriangleSkeleton& triangle, const Vec3d& p,
                                                const Kernel& kernel) {
  constexpr double most_cancelled = 64;  // two digits of those of the sides
  if (kernel.family == KernelFamily::Inverse) return triangle_by_sides<Order>(triangle, p, kernel.degree);
  auto plate = plate_seen_from(triangle, p);
  if (!plate || !plate->is_even() || !(plate->beside <= most_cancelled * plate->narrowest)) return {};
  if (kernel.family == KernelFamily::Compact) return compact_plate_field<Order>(*plate, kernel);
  const Profile profile(kernel, 2);
  const double h = plate->height, s = kernel.shape;
  plate->height = std::sqrt(h * h + 1 / (s * s));
  const double scale = 1 / (half_power(s * s, profile.degree()) * profile.normalisation());
  return even_plate_field<Order>(*plate, {profile.degree(), scale}, h);
}

template std::optional<SkeletonSample> triangle_by_sides<Derivatives::ScaleInvariant>(const TriangleSkeleton&,
                                                                                      const Vec3d&, int);
template std::optional<SkeletonSample> triangle_by_sides<Derivatives::First>(const TriangleSkeleton&, const Vec3d&,
                                                                             int);
template std::optional<SkeletonSample> triangle_by_sides<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&,
                                                                              int);
template std::optional<SkeletonSample> triangle_by_sides<Derivatives::ScaleInvariant>(const TriangleSkeleton&,
                                                                                      const Vec3d&, const Kernel&);
template std::optional<SkeletonSample> triangle_by_sides<Derivatives::First>(const TriangleSkeleton&, const Vec3d&,
                                                                             const Kernel&);
template std::optional<SkeletonSample> triangle_by_sides<Derivatives::Second>(const TriangleSkeleton&, const Vec3d&,
                                                                              const Kernel&);

}  // namespace marrow
