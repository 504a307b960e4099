// The integrals J(j, m) of t^j (t^2 + h^2)^(-m/2) over an interval, by recurrence.
#pragma once

#include <array>
#include <cstddef>

#include "field/kernel/inverse_family.h"

namespace marrow {

/// Closed forms, all from one atan2 (even m) or asinh (odd m):
///   J(0,m) = ([t d^(2-m)] + (m-3) J(0,m-2)) / ((m-2) h^2),   J(1,m) = -[d^(2-m)] / (m-2),
///   J(j,m) = J(j-2,m-2) - h^2 J(j-2,m),   d = sqrt(t^2 + h^2), [.] = value at t2 minus value at t1.
/// Only m of one parity, `parity` to max_m. Accurate (1e-13) where the interval holds 0 and is not short
/// against h; elsewhere the recurrences cancel.
class PowerIntegrals {
 public:
  /// t1 < t2, h_squared > 0. For powers up to t^(k+i) over d^(n+2i), which a radius of power k asks for: holds J(j, m)
  /// for m = max_m, max_m - 2, ... >= 1 and j <= min(m, j_of(m)).
  PowerIntegrals(double t1, double t2, double h_squared, int max_m, int n, int k);

  /// Precondition: m has the parity of max_m, m <= max_m, 0 <= j <= min(m, j_of(m)).
  double operator()(int j, int m) const { return table_[row(m)][static_cast<std::size_t>(j)]; }

  /// The largest j: k + i for m = n + 2 i; below n what J(k, n) is made from.
  int j_of(int m) const { return m >= n_ ? k_ + (m - n_) / 2 : k_ - (n_ - m); }

 private:
  static constexpr std::size_t largest_m = max_kernel_degree + 4;
  static constexpr std::size_t row(int m) { return static_cast<std::size_t>(m) / 2; }

  int n_, k_;
  std::array<std::array<double, largest_m + 1>, largest_m / 2 + 1> table_;
};

}  // namespace marrow
