// What a far source leaves of its Taylor series anywhere in a cube, by the direction in which it lies.
#include "field/trace/kernels/cube_remainder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "field/math/taylor_remainder.h"
#include "field/trace/sources/far_field.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

// Gegenbauer polynomials C_0 .. C_(k-1) of one index.
using Series = std::array<double, 96>;

Series gegenbauer(double index, double c) {
  Series s{1, 2 * index * c};
  for (std::size_t k = 2; k < s.size(); ++k) {
    const auto order = static_cast<double>(k);
    s[k] = (2 * (order + index - 1) * c * s[k - 1] - (order + 2 * index - 2) * s[k - 2]) / order;
  }
  return s;
}

struct Remainders {
  double field = 0, gradient = 0;
};

// Of |x - r|^-m about 0 beyond a degree, relative to |r|^-m, and of its gradient, relative to m |r|^-(m+1): absolute
// values of the terms, |x| / |r| = q and c the cosine of the angle between them.
Remainders beyond(int degree, int m, double q, double c) {
  const Series at = gegenbauer(m / 2.0, c), turned = gegenbauer(m / 2.0 + 1, c);
  const double sine = std::sqrt(std::max(0.0, 1 - c * c));
  Remainders sum;
  double power = std::pow(q, degree + 1);
  for (std::size_t k = static_cast<std::size_t>(degree) + 1; k + 1 < at.size(); ++k, power *= q) {
    sum.field += std::fabs(at[k]) * power;
    sum.gradient += std::hypot(static_cast<double>(k + 1) * at[k + 1], m * sine * turned[k]) / m * power;
  }
  return sum;
}

template <int FarDegree>
double share_of(double spread) {
  for (int i = 0; i < remainder_steps; ++i)
    if (spread <= static_cast<double>(remainder_spread[i]))
      return static_cast<double>(CubeRemainder<FarDegree>::share[i]);
  return 1;
}

// Sources in a random direction, often on a plane of symmetry, as far as cubes may be from what is far.
template <int FarDegree>
void expect_shares_to_hold(unsigned seed) {
  Random random(seed);
  double tightest = 0;
  for (int i = 0; i < 200'000; ++i) {
    Vec3d u = abs(random_direction(random));
    if (i % 3 == 1) u = {u.x, u.y, 0};
    if (i % 3 == 2) u = {u.x, u.y, u.y};
    u = normalize(u);
    Vec3d x = random.vector(1);
    x = x / max_component(abs(x));  // on a face
    if (i % 5 == 0) x = {x.x > 0 ? 1.0 : -1.0, x.y > 0 ? 1.0 : -1.0, x.z};
    const int m = random.whole(2, 21);
    const double q = random.between(0.01, 0.5);  // of the ball about the cube
    const Remainders found = beyond(FarDegree, m, q * length(x) / std::sqrt(3.0), dot(x, u) / length(x));
    const double share = share_of<FarDegree>(u.x + u.y + u.z);
    const double field = share * taylor_remainder(m, FarDegree, q);
    const double gradient = share * taylor_remainder(m + 1, FarDegree, q);
    ASSERT_LE(found.field, field) << "m " << m << " q " << q << " u " << u.x << ' ' << u.y << ' ' << u.z;
    ASSERT_LE(found.gradient, gradient) << "m " << m << " q " << q << " u " << u.x << ' ' << u.y << ' ' << u.z;
    tightest = std::max({tightest, found.field / field, found.gradient / gradient});
  }
  std::cout << "  largest remainder over bound " << tightest << '\n';
  EXPECT_GT(tightest, 0.8);
}

TEST(CubeRemainder, HoldsInTheWholeCube) {
  expect_shares_to_hold<low_far_degree>(61);
  expect_shares_to_hold<high_far_degree>(62);
  expect_shares_to_hold<highest_far_degree>(63);
}

}  // namespace
}  // namespace marrow::test
