// Gathers sources far from a box into Taylor polynomials; internal to blend/.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "field/blend/sources/far_polynomial.h"
#include "field/blend/sources/source_sums.h"

namespace marrow {

/// For one box: what of its sources is far enough, and what they add up to.
class FarExpansion {
 public:
  /// Each source may be off by `error` times its field anywhere in the box, as far as that is between `share` and 1.
  /// `lifted`: whether sources may have lifts; `marked`: whether they have marks.
  FarExpansion(const Box3&, bool lifted, bool marked, double error, double share);

  /// A source of one exponent, from the middle of the box.
  struct View {
    double distance, field;           ///< D and w D^-m
    double f_remainder, S_remainder;  ///< over the field, and over m tau / D times it
  };
  /// Nothing where it is not so far away.
  std::optional<View> seen(const Source&, int exponent) const;
  void add(const Source&, int exponent, const View&);

  /// By how much those added may be off, together.
  double f_error() const { return bounds_.f_error; }
  double S_error() const { return bounds_.S_error; }
  /// Those added, and what `outer`, of a ball that holds the box, or null, stands for.
  std::unique_ptr<const FarPolynomial> polynomial(const FarPolynomial* outer);
  /// The same of their sums with marks, after polynomial().
  std::unique_ptr<const FarPolynomial> marks(const FarPolynomial* outer) const;

  static constexpr int lanes = 8;
  static constexpr int most_groups = 16;
  /// One number of each of up to 128 sources of one exponent.
  struct alignas(64) Column {
    double of[most_groups][lanes];
  };
  /// y = r / D^2, 1 / D^2 and the field in the middle of the box, in the coordinates of the polynomial.
  struct Batch {
    Column x, y, z, inverse, field, radius, mark;
    int count = 0;
  };

 private:
  using Moments = std::vector<double>;
  void add_to(Moments&, Column weight) const;
  void expand(Moments&, FarPolynomial::Coefficients&) const;
  void fold();
  void expand();

  Vec3d center_;
  double rho_, error_, share_;
  bool lifted_, marked_;
  FarPolynomial::Bounds bounds_;
  FarPolynomial::Coefficients f_{}, h_{}, first_{}, second_{};
  std::unique_ptr<Batch> batch_;
  int exponent_ = 0;  ///< of the batch and of the moments
  Moments f_moments_, h_moments_, first_moments_, second_moments_;
};

}  // namespace marrow
