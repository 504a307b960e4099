#include "field/skeleton/compact_plate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "field/kernel/panels.h"
#include "field/kernel/profile.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

using Side = Plate::Side;

// Where the support of the kernel meets the plane: a disc about the foot, of radius^2 = R^2 c.
struct Disc {
  double R2, c;
  int m;  // the power of the kernel is m/2
  bool from_foot;
};

// The part of a side that is in the disc, t = half sin(angle). There half powers of g are powers of the cosine.
struct Chord {
  double half = 0, begin = 0, end = 0, first_angle = 0, last_angle = 0;

  Chord(const Side& side, double radius2) {
    const double half2 = radius2 - side.inside * side.inside;
    if (!(half2 > 0) || !(side.t1 * std::fabs(side.t1) < half2) || !(side.t2 * std::fabs(side.t2) > -half2)) return;
    half = std::sqrt(half2);
    begin = std::max(side.t1, -half);
    end = std::min(side.t2, half);
    first_angle = asin(begin / half);
    last_angle = asin(end / half);
  }
  bool is_empty() const { return !(begin < end); }
};

// What a side gives of J(m/2 + 1), J(m/2) and J(m/2 - 1), over c^M where it counts from the foot; and integrals along
// it of g^(m/2), of g^(m/2 - 1), and of t times that.
struct SideIntegrals {
  std::array<double, 3> angles{};
  double value = 0, fall = 0, fall_along = 0;
};

// Calls visit(t, dt, sqrt(g)). Beyond the chord's ends integrands have poles where the border is at no distance from
// the foot in the complex plane: sin(angle) = +-i inside / half. From the foot they have them where
// g^(1/2) = -c^(1/2): no nearer than a right angle.
template <class Visit>
void for_each_node_of(const Chord& chord, const Side& side, const Disc& disc, const Visit& visit) {
  const double root_of_g = chord.half / std::sqrt(disc.R2);
  const Singularity pole{0, disc.from_foot ? 2 : asinh(std::fabs(side.inside) / chord.half)};
  for_each_angle(chord.first_angle, chord.last_angle, pole, disc.m + 3, [&](double angle, double weight) {
    const auto [sine, cosine] = sincos(angle);
    visit(chord.half * sine, weight * chord.half * cosine, root_of_g * cosine);
  });
}

// (1 - y^j) / (1 - y^2), y = (g/c)^(1/2), for j = m - 2 and the next two: sums of powers of y, all positive.
void add_terms_from_foot(double y, double factor, int m, std::span<double, 3> sums) {
  double quotient = m % 2 == 0 ? 0 : 1 / (1 + y), power = m % 2 == 0 ? 1 : y;
  for (int j = m % 2; j < m - 2; j += 2, power *= y * y) quotient += power;
  for (std::size_t k = sums.size(); k-- > 0; power *= y * y) {
    sums[k] += factor * quotient;
    quotient += power;
  }
}

// g^(m/2 - 1) and the next two.
void add_terms_of_border(double power, double g, double factor, std::span<double, 3> sums) {
  for (std::size_t k = sums.size(); k-- > 0; power *= g) sums[k] -= factor * power;
}

// The angle between two places of a side as seen from the foot.
double angle_between(double t1, double t2, double inside) {
  return t1 < t2 ? atan2(inside * (t2 - t1), inside * inside + t1 * t2) : 0;
}

// What lies beyond the disc has all of c^M.
double angle_beyond(const Side& side, const Chord& chord) {
  if (chord.is_empty()) return angle_between(side.t1, side.t2, side.inside);
  return angle_between(side.t1, chord.begin, side.inside) + angle_between(chord.end, side.t2, side.inside);
}

SideIntegrals integrals_along(const Side& side, const Disc& disc) {
  const double e = side.inside, root_of_c = std::sqrt(disc.c);
  const Chord chord(side, disc.R2 * disc.c);
  SideIntegrals sums;
  if (disc.from_foot) sums.angles.fill(angle_beyond(side, chord));
  if (chord.is_empty()) return sums;
  for_each_node_of(chord, side, disc, [&](double t, double dt, double root) {
    const double lower = integer_power(root, disc.m - 2), g = root * root;
    if (disc.from_foot) add_terms_from_foot(root / root_of_c, e * dt / (disc.R2 * disc.c), disc.m, sums.angles);
    else add_terms_of_border(lower, g, e * dt / (t * t + e * e), sums.angles);
    sums.fall += dt * lower;
    sums.value += dt * lower * g;
  });
  const auto power_at = [&](double t) {
    return half_power(std::max(0.0, (chord.half - t) * (chord.half + t) / disc.R2), disc.m);
  };
  sums.fall_along = disc.R2 / disc.m * (power_at(chord.begin) - power_at(chord.end));
  return sums;
}

}  // namespace

template <Derivatives Order>
SkeletonSample compact_plate_field(const Plate& plate, const Kernel& kernel) {
  const Profile profile(kernel, 2);
  const double R2 = kernel.shape * kernel.shape, h = plate.height, c = (kernel.shape - h) * (kernel.shape + h) / R2;
  SkeletonSample sum;
  if (!(c > 0) || !(plate.beside * plate.beside < R2 * c)) return sum;
  // As of Plate: c^M adds up to nothing where the foot is outside, and may stay where no more than 0.75^-M of g^M.
  const Disc disc{R2, c, profile.degree(), 4 * plate.beside * plate.beside <= R2 * c};
  const double scale = 1 / profile.normalisation(), m = disc.m, bend = m * scale / (R2 * plate.unit);
  std::array<double, 3> J{};
  for (const Side& side : plate.sides) {
    const SideIntegrals got = integrals_along(side, disc);
    for (std::size_t k = 0; k < J.size(); ++k) J[k] += got.angles[k];
    sum.si_gradient -= side.out * (scale * got.value);
    if constexpr (Order >= Derivatives::Second) {
      const Vec3d in_plane = side.out * (side.inside * got.fall) + side.along * got.fall_along;
      const Vec3d across = plate.normal * (h * got.fall);
      sum.si_jacobian += Matrix3::outer(side.out, (across - in_plane) * bend) + Matrix3::outer(across * bend, side.out);
    }
  }
  if (disc.from_foot)
    for (std::size_t k = 0; k < J.size(); ++k) J[k] *= half_power(c, disc.m + 2 - 2 * static_cast<int>(k));
  sum.value = scale * R2 / (m + 2) * J[0];
  sum.si_gradient += plate.normal * (-scale * h * J[1]);
  if constexpr (Order >= Derivatives::Second)
    sum.si_jacobian +=
        Matrix3::outer(plate.normal, plate.normal) * (scale / plate.unit * (m * h * h / R2 * J[2] - J[1]));
  if constexpr (Order >= Derivatives::First) sum.gradient = sum.si_gradient / plate.unit;
  return sum;
}

template SkeletonSample compact_plate_field<Derivatives::ScaleInvariant>(const Plate&, const Kernel&);
template SkeletonSample compact_plate_field<Derivatives::First>(const Plate&, const Kernel&);
template SkeletonSample compact_plate_field<Derivatives::Second>(const Plate&, const Kernel&);

}  // namespace marrow
