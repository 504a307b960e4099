// Slides the planes across an axis.
#pragma once

#include <cstddef>
#include <string>

#include "field/math/affine.h"
#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// A point at height h over `center` along the axis moves by h * amount across it; volumes stay.   [Barr 1984]
struct Shear {
  static constexpr NodeInfo info{"shear", "Slides its child sideways, evenly along an axis.", 1, 1};
  Vec3d center{};
  UnitVec3 axis = UnitVec3::unchecked({0, 1, 0}), toward = UnitVec3::unchecked({1, 0, 0});
  double amount = 0;

  static void keys(auto&& key) {
    key("center", &Shear::center, form::Position{}, "a point of the plane that stays");
    key("axis", &Shear::axis, form::Direction{}, "direction across the planes that slide");
    key("toward", &Shear::toward, form::Direction{}, "where they slide; its part along the axis does not count");
    key("amount", &Shear::amount, form::Real{.min = -1e6, .max = 1e6}, "way they slide for each unit along the axis");
  }
  std::string problem(std::size_t) const {
    return marrow::length(across()) > 1e-6 ? "" : "toward must not point along the axis";
  }
  Box3 support(const Box3& child) const;

  /// The same as a placement of the child.
  Affine parent_from_child() const {
    Affine map = Affine::translate(step() * -dot(center, axis.vec()));
    for (std::size_t k = 0; k < 3; ++k) map.columns[k] += step() * axis.vec()[k];
    return map;
  }

  template <Number X>
  Vec3<X> child_point(const Vec3<X>& p) const {
    return p - constant<X>(step()) * dot(p - constant<X>(center), constant<X>(axis));
  }

 private:
  Vec3d across() const { return toward.vec() - axis * dot(axis, toward); }
  Vec3d step() const { return normalize(across()) * amount; }
};

}  // namespace marrow
