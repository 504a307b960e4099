// Potential functions: from the distance to a surface to the bounded field of a Blobtree primitive.
#pragma once

#include <string_view>
#include <variant>

#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// A profile w(x) falls from w(0) = most to w(1) = 0 with zero slope at both ends; it passes 1 at `surface`.
/// (1 - x^2)^3, scaled by 2 so that the usual iso-value 1/2 is 1 here.   [Wyvill]
struct WyvillProfile {
  static constexpr NodeInfo info{"wyvill", "(1 - x^2)^3, the Blobtree's usual one."};
  double range = 1;
  static void keys(auto&& key) {
    key("range", &WyvillProfile::range, form::positive, "distance from the surface at which it is 0");
  }

  /// x where 2 (1 - x^2)^3 = 1: sqrt(1 - 2^(-1/3)).
  static constexpr double surface = 0.45420210222417107;
  template <Number X>
  static X profile(const X& x) {
    return X(2.0) * integer_power(X(1.0) - square(x), 3);
  }
};

using Potential = std::variant<WyvillProfile>;

/// The field at signed distance d from a surface (negative inside): 1 there, 0 beyond `range`, constant deep inside.
template <class Profile, Number X>
X bounded_field(const Profile& potential, const X& distance) {
  const double per_length = (1 - Profile::surface) / potential.range;
  const X x = X(Profile::surface) + distance * X(per_length);
  return Profile::profile(clamp(x, 0, 1));
}
template <Number X>
X bounded_field(const Potential& potential, const X& distance) {
  return std::visit([&](const auto& profile) { return bounded_field(profile, distance); }, potential);
}
inline double range_of(const Potential& potential) {
  return std::visit([](const auto& profile) { return profile.range; }, potential);
}

}  // namespace marrow
