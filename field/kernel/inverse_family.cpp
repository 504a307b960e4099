// Normalisation as a table; the reference curve with the cheapest root for each degree.
#include "field/kernel/inverse_family.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "field/math/elementary.h"

namespace marrow {

namespace {

// I(n) = int cos^(n-2) over a half turn = sqrt(pi) Gamma((n-1)/2) / Gamma(n/2);
// I(2) = pi, I(3) = 2, I(n) = I(n-2) (n-3)/(n-2).
constexpr auto curve_normalisations = [] {
  std::array<double, max_kernel_degree + 1> table{};
  table[2] = std::numbers::pi;
  table[3] = 2;
  for (std::size_t n = 4; n < table.size(); ++n)
    table[n] = table[n - 2] * static_cast<double>(n - 3) / static_cast<double>(n - 2);
  return table;
}();

}  // namespace

double curve_normalisation(int family_degree) { return curve_normalisations[static_cast<std::size_t>(family_degree)]; }

ReferenceCurve::ReferenceCurve(int family_degree) : degree_(family_degree) {}

double ReferenceCurve::inverse_distance(double f) const {
  if (degree_ == 3) return std::sqrt(f);
  if (degree_ == 4) return cbrt(f);
  if (degree_ == 5) return std::sqrt(std::sqrt(f));
  return pow(f, 1.0 / (degree_ - 1));
}

double ReferenceCurve::inverse(double G) const { return pow(G / (degree_ - 1), (degree_ - 1.0) / degree_); }

}  // namespace marrow
