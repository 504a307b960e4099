// The Cauchy and the compact kernel with their normalisations.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

/// k as a function of y = (distance / radius)^2, with its first two derivatives.
struct ProfileSample {
  double value, slope, curvature;
};

/// k_m of a point (dimension 0) or a curve (1), normalised so that f = 1 at a radius from a point or an infinite line.
///   Cauchy   (1 + s^2 y)^(-m/2),     m = n - 1 + dimension
///   compact  (1 - y / R^2)^(m/2),    m = n + 1 - dimension; 0 beyond y = R^2     [field-maths 1]
/// Precondition: the family is not the inverse one; s > 0, R > 1.
class Profile {
 public:
  Profile(const Kernel&, int dimension);

  int degree() const { return degree_; }
  double normalisation() const { return normalisation_; }
  /// Precondition for the compact kernel: y <= R^2.
  ProfileSample at(double y) const;

 private:
  Kernel kernel_;
  int degree_;
  double normalisation_;
};

}  // namespace marrow
