// Ricci's blend: the p-norm of the fields.
#pragma once

#include <span>

#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// (sum f_i^p)^(1/p): 1 is the sum, large is nearly the crisp union.   [Ricci 1973]
struct Ricci {
  static constexpr NodeInfo info{"ricci", "Blend whose sharpness is a power: 1 is the sum, infinity the union.", 1,
                                 any_number_of_children};
  static constexpr bool ignores_zeros = true;
  double power = 2;

  static void keys(auto&& key) {
    key("power", &Ricci::power, form::Real{.min = 1, .max = 1000}, "p of (sum f^p)^(1/p)");
  }
  double child_level(double level, std::size_t children) const {
    return level / pow(static_cast<double>(children), 1 / power);
  }
  /// Scaled by the largest field, so that powers neither overflow nor vanish.
  template <Number X>
  X value(std::span<const X> f) const {
    double largest = 0;
    for (const X& x : f) largest = max(largest, upper(x));
    if (!(largest > 0)) return X(0.0);
    if (!(largest < std::numeric_limits<double>::infinity())) return largest_of(f);
    X sum(0.0);
    for (const X& x : f) sum = sum + pow(x * X(1 / largest), power);
    return X(largest) * pow(sum, 1 / power);
  }

 private:
  // Where a field has no upper bound the blend has none, and it is at least the largest field.
  template <Number X>
  static X largest_of(std::span<const X> f) {
    if constexpr (is_enclosure<X>) {
      double least = 0;
      for (const X& x : f) least = max(least, lower(x));
      return at_least<X>(least);
    } else {
      return X(std::numeric_limits<double>::infinity());
    }
  }
};

}  // namespace marrow
