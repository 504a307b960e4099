// A kernel of any family with its normalisation for points, curves and surfaces.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

/// k as a function of y = (distance / radius)^2, with its first two derivatives.
struct ProfileSample {
  double value, slope, curvature;
};

/// k_m of a point (dimension 0), a curve (1) or a surface (2), normalised so that f = 1 at a radius from a point, an
/// infinite line or an infinite plane.
///   inverse  y^(-m/2),               m = n - 1 + dimension
///   Cauchy   (1 + s^2 y)^(-m/2),     m = n - 1 + dimension
///   compact  (1 - y / R^2)^(m/2),    m = n + 1 - dimension; 0 beyond y = R^2     [degrees: inverse_family.h]
/// Precondition: s > 0, R > 1.
class Profile {
 public:
  Profile(const Kernel&, int dimension);

  int degree() const { return degree_; }
  double normalisation() const { return normalisation_; }
  /// y >= 0, for the inverse kernel > 0.
  ProfileSample at(double y) const;
  /// The third derivative.
  double third(double y) const;

 private:
  Kernel kernel_;
  int degree_;
  double normalisation_;
};

}  // namespace marrow
