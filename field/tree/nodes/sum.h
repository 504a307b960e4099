// The plain blend: the sum of the fields.
#pragma once

#include <span>

#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// Blinn's blend; for kernels with a finite range Wyvill's soft objects.   [Blinn 1982; Wyvill et al. 1986]
struct Sum {
  static constexpr NodeInfo info{"sum", "Blend of all its children: their fields are added.", 1,
                                 any_number_of_children};
  static constexpr bool ignores_zeros = true;
  static void keys(auto&&) {}

  double child_level(double level, std::size_t children) const { return level / static_cast<double>(children); }
  template <Number X>
  X value(std::span<const X> f) const {
    X sum = f[0];
    for (const X& x : f.subspan(1)) sum += x;
    return sum;
  }
};

}  // namespace marrow
