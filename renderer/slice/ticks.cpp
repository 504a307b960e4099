#include "renderer/slice/ticks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace marrow {
namespace {

struct Decade {
  double mantissa;  ///< 1 <= mantissa < 10
  int exponent;
};

// By printing and not by log10, whose last bit may fall on the wrong side of a power of ten.
Decade decade(double value) {
  const std::string text = fmt::format("{:.15e}", value);
  const std::size_t e = text.find('e');
  return {std::stod(text.substr(0, e)), std::stoi(text.substr(e + 1))};
}

// Correctly rounded, unlike a product with a power of ten.
double scaled(int mantissa, int exponent) { return std::stod(fmt::format("{}e{}", mantissa, exponent)); }

}  // namespace

double round_length(double length) {
  const auto [mantissa, exponent] = decade(length);
  return scaled(mantissa >= 5 ? 5 : mantissa >= 2 ? 2 : 1, exponent);
}

std::vector<double> ticks(double low, double high, int most) {
  if (!(high > low) || !std::isfinite(high - low)) return {low};
  std::vector<double> found;
  for (int exponent = decade((high - low) / most).exponent;; ++exponent)
    for (const int mantissa : {1, 2, 5}) {
      const double step = scaled(mantissa, exponent);
      const double slack = 1e-9 * step;  // an end that is a multiple but for rounding counts as one
      const double first = std::ceil((low - slack) / step), last = std::floor((high + slack) / step);
      if (last - first + 1 > most) continue;
      for (double i = first; i <= last; ++i) found.push_back(i * step);
      return found;
    }
}

std::string label(double value, double step) {
  const double magnitude = std::fabs(value);
  if (magnitude < 1e-6 * step) return "0";
  const int of_step = decade(step).exponent;
  std::string text;
  if (magnitude >= 1e-4 && magnitude < 1e6) {
    text = fmt::format("{:.{}f}", magnitude, std::clamp(1 - of_step, 0, 15));
    if (text.find('.') != std::string::npos) {
      text.resize(text.find_last_not_of('0') + 1);
      if (text.back() == '.') text.pop_back();
    }
  } else {
    text = fmt::format("{:.{}g}", magnitude, std::clamp(decade(magnitude).exponent - of_step + 2, 1, 15));
  }
  return value < 0 ? "\u2212" + text : text;
}

}  // namespace marrow
