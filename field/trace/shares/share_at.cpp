#include "field/trace/shares/share_at.h"

#include <cstddef>
#include <utility>

#include "field/trace/sources/far_field.h"

namespace marrow {
namespace {

// A monomial as z[axis] times one before it; its exponents, and the monomials with one factor less.
struct Factors {
  std::size_t axis, without[3];
  int exponent[3];

  constexpr explicit Factors(const Monomial& of) : axis(0), without{}, exponent{of.a, of.b, of.c} {
    for (std::size_t k = 0; k < 3; ++k) {
      if (exponent[k] == 0) continue;
      axis = k;
      without[k] = monomial_index(of.a - (k == 0), of.b - (k == 1), of.c - (k == 2));
    }
  }
};

// The value of a polynomial and its slopes, monomial after monomial.
struct ValueAndSlopes {
  const double (&z)[3];
  double of_monomial[SharePatch::coefficients] = {1};
  double value, slope[3] = {0, 0, 0};

  template <std::size_t... Before>
  ValueAndSlopes(const float (&coefficient)[SharePatch::coefficients], const double (&at)[3],
                 std::index_sequence<Before...>)
      : z(at), value(static_cast<double>(coefficient[0])) {
    (add<Before + 1>(static_cast<double>(coefficient[Before + 1])), ...);
  }

 private:
  template <std::size_t Number>
  void add(double c) {
    constexpr Factors f(monomials[Number]);
    of_monomial[Number] = of_monomial[f.without[f.axis]] * z[f.axis];
    value += c * of_monomial[Number];
    if constexpr (f.exponent[0] > 0) slope[0] += c * f.exponent[0] * of_monomial[f.without[0]];
    if constexpr (f.exponent[1] > 0) slope[1] += c * f.exponent[1] * of_monomial[f.without[1]];
    if constexpr (f.exponent[2] > 0) slope[2] += c * f.exponent[2] * of_monomial[f.without[2]];
  }
};

}  // namespace

ShareAt share_at(const SharePatch& patch, const Vec3d& at) {
  const double scale = static_cast<double>(patch.inverse_half);
  double z[3];
  for (std::size_t k = 0; k < 3; ++k) z[k] = (at[k] - static_cast<double>(patch.center[k])) * scale;
  const ValueAndSlopes at_z(patch.coefficient, z, std::make_index_sequence<SharePatch::coefficients - 1>());
  ShareAt out;
  out.share = at_z.value;
  for (std::size_t k = 0; k < 3; ++k) out.gradient[k] = at_z.slope[k] * scale;
  out.bend = static_cast<double>(patch.bend);
  out.error = static_cast<double>(patch.error);
  return out;
}

}  // namespace marrow
