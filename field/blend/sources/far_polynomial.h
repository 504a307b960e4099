// What lies far from a box, as Taylor polynomials about its middle.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "field/blend/sources/mark_sums.h"
#include "field/math/box3.h"
#include "field/math/monomials.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// Sums over sources far away, in a ball around a place: f, and h with grad h = grad_S f.   [taylor_remainder.h]
/// Or, in their places, those of MarkSums; then only marks_at() is asked.
class FarPolynomial {
 public:
  static constexpr int degree = 13;  ///< of both, so that grad_S f is exact to one less
  static constexpr std::size_t coefficient_count = monomials_to_degree(degree);
  /// In x = (p - center) / radius.
  using Coefficients = std::array<double, coefficient_count>;

  /// What holds in the ball of `radius` around `center`.
  struct Bounds {
    double f_error = 0, S_error = 0;  ///< by how much f and grad_S f differ from the sums over the sources, at most
    double steepest = 0;              ///< |grad f| at most
    double second = 0;                ///< |second derivatives of f| at most
    double S_second = 0;              ///< |second derivatives of grad_S f| at most
    double log_slope = 0;             ///< |grad ln f_i| of any source at most
    double S_longest = 0;             ///< |grad_S f| at most

    Bounds& operator+=(const Bounds&);
  };

  FarPolynomial(const Vec3d& center, double radius, const Coefficients& f, const Coefficients& h, const Bounds&);

  /// All of it at p, a place in the ball. The same bits on every instruction set.
  SkeletonSample at(const Vec3d& p) const;
  /// Only value and si_gradient.
  SkeletonSample value_at(const Vec3d& p) const;
  MarkSums marks_at(const Vec3d& p) const;

  const Bounds& bounds() const { return bounds_; }
  /// Adds it to coefficients about another place, for a ball inside this one.
  void add_to(const Vec3d& center, double radius, Coefficients& f, Coefficients& h) const;
  std::size_t bytes() const { return sizeof *this + blocks_.capacity() * sizeof(Block); }

  static constexpr int lanes = 8;
  /// One power of z for four pairs of powers of x and y with the same sum: of f, then of h.
  struct alignas(64) Block {
    double c[lanes];
  };

 private:
  Vec3d center_;
  double radius_;
  Bounds bounds_;
  std::vector<Block> blocks_;
};

}  // namespace marrow
