// The nodes of a compiled tree: the general kinds and what blends, placements and unions become.
#pragma once

#include <memory>
#include <variant>

#include "field/blend/blend_field.h"
#include "field/math/affine.h"
#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/any_node.h"
#include "field/tree/point_leaf.h"

namespace marrow {

/// One n-ary blend as a primitive.
struct BlendLeaf {
  std::shared_ptr<const BlendField> field;
};

/// Places its child.
struct AffineWarp {
  Affine parent_from_child, child_from_parent;

  Box3 support(const Box3& child) const;
  template <Number X>
  Vec3<X> child_point(const Vec3<X>& p) const {
    const auto& [x, y, z] = child_from_parent.columns;
    return constant<X>(x) * p.x + constant<X>(y) * p.y + constant<X>(z) * p.z +
           constant<X>(child_from_parent.translation);
  }
};

namespace tree {

template <class Variant, class... More>
struct Extended;
template <class... Kinds, class... More>
struct Extended<std::variant<Kinds...>, More...> {
  using type = std::variant<Kinds..., More...>;
};

}  // namespace tree

/// Any node of a compiled tree.
struct TreeNode : tree::Extended<AnyNode, BlendLeaf, PointLeaf, AffineWarp, CrispUnion>::type {
  using Kinds = tree::Extended<AnyNode, BlendLeaf, PointLeaf, AffineWarp, CrispUnion>::type;
  using Kinds::Kinds;
};

}  // namespace marrow
