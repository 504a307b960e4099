// From moments of weighted points to Taylor coefficients of their sum of inverse powers of the distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/math/monomials.h"

namespace marrow {

/// Taylor coefficients about 0 of sum w D^-m, D^2 = |x - r|^2 + l^2. The expansion is Gegenbauer's [DLMF 18.12.4],
/// D^-m = sum_k C_k^(m/2)(cos) |x|^k R^-(m+k) with R^2 = |r|^2 + l^2 and cos = x.r / (|x| R). Its terms are
/// (x.r)^k |x|^(2j) R^-(m+2k+2j) times a constant, so that with y = r / R^2 the moments needed to a degree P are
///   sum w R^-m y^(tensor k) R^-(2j)   for k + 2j <= P
/// (56 + 20 + 4 numbers for P = 5). Without lifts, R^-2 = |y|^2, and those with j = 0 give the others.
class MomentSeries {
 public:
  /// For one exponent m and all degrees up to P.
  MomentSeries(int exponent, int degree);

  /// Moments are held one j after the other, each in the order of monomials: how many there are, and where those of a j
  /// begin.
  static constexpr std::size_t count(int degree) {
    return degree < 0 ? 0 : monomials_to_degree(degree) + count(degree - 2);
  }
  std::size_t first(int j) const { return count(degree_) - count(degree_ - 2 * j); }
  /// Those with j > 0 of points without lifts, as far as moments of degrees up to `degree` lead.
  void complete(std::span<double> moments, int degree) const;
  /// Adds the terms of degrees up to `degree`.
  void add_to(std::span<double> coefficients, std::span<const double> moments, int degree) const;

 private:
  struct Term {
    std::uint16_t moment, monomial;
    double factor;
  };
  int degree_;
  std::vector<Term> terms_;               // by the degree of their monomials
  std::vector<std::size_t> terms_up_to_;  // how many, by degree
};

}  // namespace marrow
