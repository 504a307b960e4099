// Potential functions: from the distance to a surface to the bounded field of a Blobtree primitive.
//
// A profile w(x) falls from its most at x = 0 to 0 at x = 1 with zero slope at both ends. Usual texts put the surface
// where w is 1/2 of w(0); here the profile is scaled by 2, so that it is 1 there, at x = surface().
#pragma once

#include <array>
#include <variant>

#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// (1 - x^2)^3, the Blobtree's usual one.   [Wyvill, McPheeters, Wyvill 1986]
struct WyvillProfile {
  static constexpr NodeInfo info{"wyvill", "(1 - x^2)^3, the Blobtree's usual one."};
  double range = 1;
  static void keys(auto&& key) {
    key("range", &WyvillProfile::range, form::positive, "distance from the surface at which it is 0");
  }

  /// sqrt(1 - 2^(-1/3)), where 2 (1 - x^2)^3 = 1.
  static constexpr double surface() { return 0.4542020189474065; }
  template <Number X>
  static X profile(const X& x) {
    return 2.0 * integer_power(1.0 - square(x), 3);
  }
};

/// (1 - x^2)^k: Wyvill's with a free degree.
struct PolynomialProfile {
  static constexpr NodeInfo info{"polynomial", "(1 - x^2)^degree: the higher the degree, the softer its end."};
  static constexpr int least = 2, most = 12;
  double range = 1;
  int degree = 3;
  static void keys(auto&& key) {
    key("range", &PolynomialProfile::range, form::positive, "distance from the surface at which it is 0");
    key("degree", &PolynomialProfile::degree, form::Whole{least, most},
        "2 gives continuous slopes at the range, 3 continuous curvatures too");
  }

  /// sqrt(1 - 2^(-1/k)), where 2 (1 - x^2)^k = 1; k = 2, 3, ...
  static constexpr std::array<double, most - least + 1> surfaces{
      0.541196100146197,   0.4542020189474065,  0.3988779070671694,  0.35979082354039527,
      0.3303048317231534,  0.3070445175151208,  0.28809018864815367, 0.2722595961811256,
      0.25877984555060035, 0.24712160840018352, 0.23690860541210085};
  double surface() const { return surfaces[static_cast<std::size_t>(degree - least)]; }
  template <Number X>
  X profile(const X& x) const {
    return 2.0 * integer_power(1.0 - square(x), degree);
  }
};

/// 1 - 22/9 x^2 + 17/9 x^4 - 4/9 x^6, which is 1/2 at x = 1/2 exactly.   [Wyvill, McPheeters, Wyvill 1986]
struct SoftObjectProfile {
  static constexpr NodeInfo info{"soft_object", "1 - 22/9 x^2 + 17/9 x^4 - 4/9 x^6, that of the first soft objects."};
  double range = 1;
  static void keys(auto&& key) {
    key("range", &SoftObjectProfile::range, form::positive, "distance from the surface at which it is 0");
  }

  static constexpr double surface() { return 0.5; }
  /// As the product (1 - u)^2 (1 - 4/9 u), u = x^2: both factors fall, so that ranges of values are exact.
  template <Number X>
  static X profile(const X& x) {
    const X u = square(x);
    return 2.0 * square(1.0 - u) * (1.0 - (4.0 / 9) * u);
  }
};

/// 1 - 3 x^2 up to x = 1/3, then 3/2 (1 - x)^2.   [Nishimura et al. 1985]
struct MetaballProfile {
  static constexpr NodeInfo info{"metaball", "Nishimura's piecewise quadratic: 1 - 3 x^2, then 3/2 (1 - x)^2."};
  double range = 1;
  static void keys(auto&& key) {
    key("range", &MetaballProfile::range, form::positive, "distance from the surface at which it is 0");
  }

  /// 1 - 1/sqrt(3), where 3 (1 - x)^2 = 1.
  static constexpr double surface() { return 0.4226497308103742; }
  template <Number X>
  static X profile(const X& x) {
    return piecewise(
        x, 1.0 / 3, [](const X& near) { return 2.0 - 6.0 * square(near); },
        [](const X& far) { return 3.0 * square(1.0 - far); });
  }
};

/// The first is the default.
using Potential = std::variant<WyvillProfile, PolynomialProfile, SoftObjectProfile, MetaballProfile>;

/// The field at signed distance d from a surface (negative inside): 1 there, 0 from `range` on; inside it rises until
/// d = -range surface() / (1 - surface()), and is constant deeper.
template <class Profile, Number X>
X bounded_field(const Profile& potential, const X& distance) {
  const double per_length = (1 - potential.surface()) / potential.range;
  const X x = potential.surface() + distance * per_length;
  return piecewise(
      x, 1, [&](const X& near) { return known_within(potential.profile(max(near, X(0.0))), 0, 2); },
      [](const X&) { return X(0.0); });
}
template <Number X>
X bounded_field(const Potential& potential, const X& distance) {
  return std::visit([&](const auto& profile) { return bounded_field(profile, distance); }, potential);
}
inline double range_of(const Potential& potential) {
  return std::visit([](const auto& profile) { return profile.range; }, potential);
}

}  // namespace marrow
