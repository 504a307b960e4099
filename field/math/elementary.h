// Elementary functions with the same bits on every machine.
// glibc picks code by processor and so differs in last bits between them; pictures must not
//. sqrt is exact by IEEE 754 and comes from <cmath>.
#pragma once

#include <cmath>

namespace marrow {

double sin(double);
double cos(double);
struct SinCos {
  double sin, cos;
};
SinCos sincos(double);
double tan(double);
double asin(double);
double acos(double);
double atan(double);
double atan2(double y, double x);
double exp(double);
double expm1(double);
double log(double);
double log1p(double);
double pow(double base, double exponent);
double cbrt(double);
double sinh(double);
double cosh(double);
double asinh(double);
double acosh(double);
double tgamma(double);

/// base^exponent for a whole exponent >= 0, by multiplication only.
constexpr double integer_power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent >>= 1, base *= base)
    if (exponent & 1) result *= base;
  return result;
}

/// base^(twice / 2) for a whole `twice` >= -2, base > 0 where it is negative.
inline double half_power(double base, int twice) {
  if (twice < 0) return 1 / (twice == -1 ? std::sqrt(base) : base);
  const double whole = integer_power(base, twice / 2);
  return twice % 2 == 0 ? whole : whole * std::sqrt(base);
}

}  // namespace marrow
