// The smallest tree that holds a kind of node: with balls as its children.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "field/number/variables_at.h"
#include "field/tree/machine.h"
#include "tests/tree/random_node.h"

namespace marrow::test {

template <class Kind>
struct SmallTree {
  static constexpr bool is_primitive = tree::Primitive<Kind, double>;
  static constexpr bool is_operator = tree::Operator<Kind, double>;
  Kind node;
  std::vector<Sphere> children;

  static SmallTree random(Random& random) {
    constexpr NodeInfo info = info_of_kind<Kind>();
    const std::size_t most = std::min(info.max_children, info.min_children + 3);
    const auto count =
        static_cast<std::size_t>(random.whole(static_cast<int>(info.min_children), static_cast<int>(most)));
    SmallTree made{random_node<Kind>(count, random), {}};
    for (std::size_t i = 0; i < count; ++i) made.children.push_back(random_node<Sphere>(0, random));
    return made;
  }

  template <Number X>
  X value(const Vec3<X>& p) const {
    if constexpr (is_primitive) {
      return node.value(p);
    } else if constexpr (is_operator) {
      std::vector<X> f;
      for (const Sphere& child : children) f.push_back(child.value(p));
      return node.value(std::span<const X>(f));
    } else {
      return children[0].value(node.child_point(p));
    }
  }

  Box3 support() const {
    std::vector<Box3> boxes;
    Box3 all;
    for (const Sphere& child : children) {
      boxes.push_back(child.support());
      all.include(boxes.back());
    }
    if constexpr (is_primitive) return node.support();
    else if constexpr (!is_operator) return node.support(boxes[0]);
    else if constexpr (requires { node.support(std::span<const Box3>(boxes)); }) return node.support(boxes);
    else return all;
  }
  /// Where something happens: the support, cut to a finite piece.
  Box3 region() const {
    constexpr double far = 4;
    Box3 box = support();
    for (std::size_t i = 0; i < 3; ++i) {
      box.lower[i] = std::clamp(box.lower[i] - 0.1, -far, far - 1);
      box.upper[i] = std::clamp(box.upper[i] + 0.1, box.lower[i] + 1e-3, far);
    }
    return box;
  }
  /// A point where the field changes, when a few trials find one: most of a region can be empty or deep inside.
  Vec3d eventful_point(Random& random) const {
    const Box3 box = region();
    Vec3d p;
    for (int trial = 0; trial < 6; ++trial) {
      for (std::size_t i = 0; i < 3; ++i) p[i] = random.between(box.lower[i], box.upper[i]);
      const Jet<double, 3> f = value(variables_at<Jet<double, 3>>(p));
      if (f.slope != std::array<double, 3>{}) break;
    }
    return p;
  }
};

}  // namespace marrow::test
