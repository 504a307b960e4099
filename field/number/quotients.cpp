// Series around 0, the quotients themselves elsewhere.
#include "field/number/quotients.h"

#include <cmath>

#include "field/math/elementary.h"

namespace marrow {
namespace {

struct Terms {
  double value = 0, first = 0, second = 0;
  // adds c x^k, given x^(k-2) (any number while k < 2)
  void add(double c, int k, double power_below_two, double x) {
    const double power_below = k == 1 ? 1 : power_below_two * x;
    value += c * (k == 0 ? 1 : power_below * x);
    if (k > 0) first += c * k * power_below;
    if (k > 1) second += c * k * (k - 1) * power_below_two;
  }
};

// sum c_k x^k with c_k from a rule.
template <class Coefficient>
Terms series(double x, int terms, const Coefficient& coefficient) {
  Terms d;
  double power = 1;
  for (int k = 0; k < terms; ++k) {
    d.add(coefficient(k), k, power, x);
    if (k > 1) power *= x;
  }
  return d;
}

// sum x^k / (k+1)!; for |x| < 1 twenty terms leave 1e-19.
Terms exp_series(double x) {
  double factorial = 1;
  return series(x, 20, [&](int k) { return factorial /= k + 1; });
}

// sum (-x)^k / (k+1); for |x| < 1/4 thirty terms leave 1e-18 of the second derivative.
Terms log_series(double x) {
  return series(x, 32, [](int k) { return (k % 2 == 0 ? 1.0 : -1.0) / (k + 1); });
}

}  // namespace

HessianJet exp_quotient(const HessianJet& jet) {
  const double x = jet.value;
  if (std::fabs(x) < 1) {
    const Terms d = exp_series(x);
    return HessianJet::chain(jet, d.value, d.first, d.second);
  }
  const double e = exp(x), value = expm1(x) / x, first = (e - value) / x;
  return HessianJet::chain(jet, value, first, (e - 2 * first) / x);
}

HessianJet log_quotient(const HessianJet& jet) {
  const double x = jet.value;
  if (std::fabs(x) < 0.25) {
    const Terms d = log_series(x);
    return HessianJet::chain(jet, d.value, d.first, d.second);
  }
  const double r = 1 / (1 + x), value = log1p(x) / x, first = (r - value) / x;
  return HessianJet::chain(jet, value, first, (-r * r - 2 * first) / x);
}

}  // namespace marrow
