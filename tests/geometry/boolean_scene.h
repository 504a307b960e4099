// Solids under set operations, made of their tree alone.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "renderer/geometry/boolean_solid.h"
#include "renderer/geometry/field_solid.h"

namespace marrow::test {

/// None where it is no expression of blends of more than `few` skeletons.
inline std::unique_ptr<BooleanSolid> boolean_solid_of(const FieldTree& tree, std::size_t few, MaterialId material,
                                                      const TraceOptions& options = {},
                                                      std::shared_ptr<const RaySpacing> spacing = nullptr) {
  const auto stands_alone = [&](const BlendField& blend) { return blend.size() > few; };
  auto expression = SetExpression::of(tree, tree.root(), stands_alone);
  if (!expression) return nullptr;
  const auto operands = expression->operands();
  const auto blend_solid = [&](std::size_t i) {
    const Affine& placed = operands[i].world_from_blend;
    return as_operand(FieldSolid::make({*operands[i].blend, placed, placed.inverse()}, material, options));
  };
  auto solid =
      BooleanSolid::make(tree, surface_bounds(tree), std::move(*expression), material, blend_solid, std::move(spacing));
  if (!solid) throw std::runtime_error("an operand cannot be traced");
  return std::move(*solid);
}

}  // namespace marrow::test
