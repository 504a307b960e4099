// A field ready for evaluation: placed blends and general trees under a crisp union. Immutable; cheap to share by
// reference.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "field/base/diagnostics.h"
#include "field/base/result.h"
#include "field/blend/blend_field.h"
#include "field/description/field_node.h"
#include "field/math/affine.h"
#include "field/tree/field_tree.h"

namespace marrow {

/// Similarities are baked into the primitives, so that both maps are the identity then; any other invertible
/// affine map stays here, and the blend is in local coordinates. So do all maps of a blend that is placed many times.
struct PlacedBlend {
  BlendField blend;
  Affine world_from_local, local_from_world;
  std::size_t shape = 0;   ///< parts of one program with the same shape have the same blend; 0: alone
  std::size_t shared = 0;  ///< parts of all programs with the same number too (FieldNode::shared); 0: of this one alone

  bool is_in_world() const { return world_from_local == Affine{}; }
};

/// value(p) = max over the corrected fields of the parts and the values of the trees; the surface is value = iso(),
/// inside is above.
class FieldProgram {
 public:
  FieldProgram() = default;
  /// `warnings` are what compile() has to tell besides errors.
  explicit FieldProgram(std::vector<PlacedBlend> parts, std::vector<FieldTree> trees = {}, Diagnostics warnings = {})
      : parts_(std::move(parts)), trees_(std::move(trees)), warnings_(std::move(warnings)) {}

  std::span<const PlacedBlend> parts() const { return parts_; }
  /// What is not a blend, in world coordinates.
  std::span<const FieldTree> trees() const { return trees_; }
  static constexpr double iso() { return 1; }
  const Diagnostics& warnings() const { return warnings_; }

 private:
  std::vector<PlacedBlend> parts_;
  std::vector<FieldTree> trees_;
  Diagnostics warnings_;
};

/// Flattens a description: transforms distribute over unions and compose. All errors, not the first:
/// radii <= 0, degrees and angles out of range, singular transforms, transforms inside a blend that are not
/// similarities, fields that are no skeletons inside a blend. 10^6 nodes take a fraction of a second.
Result<FieldProgram> compile(const FieldDescription&);

/// Of a field with the same surface, for who asks for no more than that: elsewhere it may have other values, as sharp
/// set operations are crisp ones then, whose operands are traced one by one.
Result<FieldProgram> compile_surface(const FieldDescription&);

struct FieldSample {
  double value = 0;
  Vec3d gradient{};       ///< d value / d world position; 0 on a skeleton
  MaterialId material{};  ///< of the strongest contribution to the part that gives the value; invalid: the object's
};
FieldSample evaluate(const FieldProgram&, const Vec3d& p);
/// Of a tree alone, without the material, which takes a search of its own.
FieldSample value_and_gradient(const FieldTree&, const Vec3d& p);

/// The `value` of evaluate(), bit for bit, at less cost.
double value(const FieldProgram&, const Vec3d& p);

/// Of the part that gives the value.
MaterialWeights material_weights(const FieldProgram&, const Vec3d& p);

/// With gradient and Hessian, composed with those of p.
HessianJet second_order_value(const FieldProgram&, const Vec3<HessianJet>& p);

/// Whether the field is one blend, so that sum, si_gradient, ... mean something for the whole field.
bool is_single_blend(const FieldProgram&);

/// The sample of one part, with all gradients with respect to world position.
/// si_gradient and si_norm stay those of the blend's own coordinates, in which the correction is defined.
BlendSample evaluate_part(const PlacedBlend&, const Vec3d& p);

/// A blend as a tree of its own, in world coordinates.
FieldTree tree_of(const PlacedBlend&);
/// The same without a copy of the blend, which must outlive it.
FieldTree tree_referring_to(const PlacedBlend&);

}  // namespace marrow
