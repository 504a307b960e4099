// The inverse kernel family of degree n: degrees, normalisation and the reference curve.
#pragma once

#include <numbers>

namespace marrow {

/// Supported degrees n of a family. Below 3 integrals diverge (Zanni et al. 2015, sec. 4.1);
/// above 20 a kernel is a step to all purposes and its powers leave the range of double.
inline constexpr int min_kernel_degree = 3, max_kernel_degree = 20;

/// Degree of k_m(x) = x^-m for a skeleton of the given dimension (point 0, curve 1, surface 2): n - 1 + dimension.
/// The printed degrees of Zanni et al. 2015, sec. 4.1 hold for the compact kernel only.
constexpr int kernel_degree(int family_degree, int dimension) { return family_degree - 1 + dimension; }

/// N of a curve: the integral of k_n(d / radius) / radius along an infinite line at d = radius 1,
/// sqrt(pi) Gamma((n-1)/2) / Gamma(n/2). (N of a point is 1.)
double curve_normalisation(int family_degree);

/// N of a surface: the same over an infinite plane, 2 pi / (n-1).
constexpr double surface_normalisation(int family_degree) { return 2 * std::numbers::pi / (family_degree - 1); }

/// The curve |grad_S f| = g(f) on which every isolated infinite skeleton lies.
/// f = x^-(n-1) and |grad_S f| = (n-1) x^-n with x = d / radius, hence g(f) = (n-1) f^(n/(n-1)).
///                                                            [Zanni et al. 2015, eq. 8-11, 13]
class ReferenceCurve {
 public:
  explicit ReferenceCurve(int family_degree);

  int degree() const { return degree_; }
  /// f^(1/(n-1)) = radius / distance of the isolated skeleton.
  double inverse_distance(double f) const;
  double at(double f) const { return (degree_ - 1) * f * inverse_distance(f); }
  double slope(double f) const { return degree_ * inverse_distance(f); }
  /// x_H: the f at which the curve has height G.
  double inverse(double G) const;

 private:
  int degree_;
};

}  // namespace marrow
