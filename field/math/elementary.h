// Elementary functions with the same bits on every machine.
// glibc picks code by processor and so differs in last bits between them; pictures must not. sqrt is exact by IEEE 754
// and comes from <cmath>.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

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

/// x^(1/degree) for an x from 1e-300 to 1e300, or 0, and a whole degree from 1 to 21; to 3 ulp, in a quarter of the
/// time of pow(). The bits of a number are nearly 2^52 (log2 x + 1023): divided as such they give the root to 4.5 %.
/// Halley's method leaves (degree^2 - 1) / 12 of the cube of an error: after three steps 1e-16 at most.
inline double root(double x, int degree) {
  if (!(x > 0)) return 0;
  constexpr std::int64_t one = std::int64_t{1023} << 52;
  constexpr double balance = 0.045 * 0x1p52;  // bits lie up to 0.086 * 2^52 below, in the root as in x
  const double logarithm = static_cast<double>(std::bit_cast<std::int64_t>(x) - one) + balance;
  double y = std::bit_cast<double>(static_cast<std::int64_t>(logarithm / degree - balance) + one);
  for (int step = 0; step < 3; ++step) {
    const double power = integer_power(y, degree);
    y *= ((degree - 1) * power + (degree + 1) * x) / ((degree + 1) * power + (degree - 1) * x);
  }
  return y;
}

/// base^(twice / 2) for a whole `twice` >= -2, base > 0 where it is negative.
inline double half_power(double base, int twice) {
  if (twice < 0) return 1 / (twice == -1 ? std::sqrt(base) : base);
  const double whole = integer_power(base, twice / 2);
  return twice % 2 == 0 ? whole : whole * std::sqrt(base);
}

}  // namespace marrow
