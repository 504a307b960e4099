// Fills the table of J(j, m) row by row, two powers of the distance at a time.
#include "field/kernel/power_integrals.h"

#include <algorithm>
#include <cmath>

#include "field/math/elementary.h"

namespace marrow {
namespace {

// J(0, 1): asinh(t2/h) - asinh(t1/h), without the difference of two large numbers where t1 < 0 < t2.
double inverse_distance_integral(double t1, double t2, double h) { return asinh(t2 / h) - asinh(t1 / h); }

// J(0, 2) by the addition theorem: one atan2, right in every quadrant.
double inverse_square_integral(double t1, double t2, double h) { return atan2(h * (t2 - t1), h * h + t1 * t2) / h; }

}  // namespace

PowerIntegrals::PowerIntegrals(double t1, double t2, double h_squared, int max_m, int n, int k) : n_(n), k_(k) {
  const double h = std::sqrt(h_squared);
  const double d1_squared = t1 * t1 + h_squared, d2_squared = t2 * t2 + h_squared;
  const double d1 = std::sqrt(d1_squared), d2 = std::sqrt(d2_squared);
  const bool even = max_m % 2 == 0;
  auto& first = table_[row(max_m % 2)];
  double power1, power2;  // d^(2-m) of the row in hand
  if (even) {
    first[0] = t2 - t1;
    auto& square = table_[row(2)];
    square[0] = inverse_square_integral(t1, t2, h);
    if (j_of(2) >= 1) square[1] = log(d2_squared / d1_squared) / 2;
    square[2] = first[0] - h_squared * square[0];
    power1 = power2 = 1;
  } else {
    // J(0, 3) takes 0 times this, and J(2, 3) is seldom asked for.
    first[0] = j_of(1) >= 0 || j_of(3) >= 2 ? inverse_distance_integral(t1, t2, h) : 0;
    first[1] = d2 - d1;
    power1 = d1;
    power2 = d2;
  }
  for (int m = even ? 4 : 3; m <= max_m; m += 2) {
    auto& current = table_[row(m)];
    const auto& previous = table_[row(m - 2)];
    power1 /= d1_squared;
    power2 /= d2_squared;
    current[0] = ((t2 * power2 - t1 * power1) + (m - 3) * previous[0]) / ((m - 2) * h_squared);
    current[1] = (power1 - power2) / (m - 2);
    for (int j = 2; j <= std::min(m, j_of(m)); ++j) {
      const auto to = static_cast<std::size_t>(j);
      current[to] = previous[to - 2] - h_squared * current[to - 2];
    }
  }
}

}  // namespace marrow
