// Takes the largest part of a program.

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "field/number/variables_at.h"
#include "field/program/field_program.h"
#include "field/tree/blend_values.h"
#include "field/tree/tree_node.h"

namespace marrow {
namespace {

double value_of(const PlacedBlend& part, const Vec3d& p) {
  return corrected_value(part.blend, part.is_in_world() ? p : part.local_from_world.point(p));
}

struct Largest {
  const PlacedBlend* part = nullptr;
  const FieldTree* tree = nullptr;
  double value = 0;
};

Largest largest_part(const FieldProgram& program, const Vec3d& p) {
  Largest best;
  const auto is_first = [&] { return best.part == nullptr && best.tree == nullptr; };
  for (const PlacedBlend& part : program.parts()) {
    const double v = value_of(part, p);
    if (is_first() || v > best.value) best = {&part, nullptr, v};
  }
  for (const FieldTree& tree : program.trees()) {
    const double v = value(tree, p);
    if (is_first() || v > best.value) best = {nullptr, &tree, v};
  }
  return best;
}

FieldSample sample_of(const PlacedBlend& part, const Vec3d& p) {
  const BlendSample s = evaluate_part(part, p);
  const Vec3d local = part.is_in_world() ? p : part.local_from_world.point(p);
  return {.value = s.corrected, .gradient = s.corrected_gradient, .material = strongest_material(part.blend, local)};
}

FieldSample sample_of(const FieldTree& tree, const Vec3d& p) {
  FieldSample sample = value_and_gradient(tree, p);
  sample.material = strongest_material(tree, p);
  return sample;
}

}  // namespace

BlendSample evaluate_part(const PlacedBlend& part, const Vec3d& p) {
  if (part.is_in_world()) return evaluate(part.blend, p);
  BlendSample s = evaluate(part.blend, part.local_from_world.point(p));
  s.sum_gradient = part.local_from_world.transposed(s.sum_gradient);
  s.corrected_gradient = part.local_from_world.transposed(s.corrected_gradient);
  return s;
}

namespace {

FieldTree tree_of(const PlacedBlend& part, std::shared_ptr<const BlendField> blend) {
  auto nodes = std::make_shared<std::vector<TreeNode>>();
  nodes->push_back(CrispUnion{});
  nodes->push_back(BlendLeaf{std::move(blend)});
  std::vector<FieldTree::Record> records{
      {.node = 1, .first_child = 0, .child_count = 0, .material = {}, .support = {}}};
  if (part.is_in_world()) return FieldTree(std::move(nodes), std::move(records), {});
  nodes->push_back(AffineWarp{part.world_from_local, part.local_from_world});
  records.push_back({.node = 2, .first_child = 0, .child_count = 1, .material = {}, .support = {}});
  return FieldTree(std::move(nodes), std::move(records), {0});
}

}  // namespace

FieldTree tree_of(const PlacedBlend& part) { return tree_of(part, std::make_shared<const BlendField>(part.blend)); }

FieldTree tree_referring_to(const PlacedBlend& part) {
  return tree_of(part, std::shared_ptr<const BlendField>(std::shared_ptr<void>{}, &part.blend));
}

FieldSample evaluate(const FieldProgram& program, const Vec3d& p) {
  if (program.trees().empty() && program.parts().size() == 1) return sample_of(program.parts().front(), p);
  const Largest largest = largest_part(program, p);
  if (largest.tree != nullptr) return sample_of(*largest.tree, p);
  return largest.part != nullptr ? sample_of(*largest.part, p) : FieldSample{};
}

FieldSample value_and_gradient(const FieldTree& tree, const Vec3d& p) {
  const auto f = value(tree, variables_at<Jet<double, 3>>(p));
  // On a skeleton operators multiply an infinite slope by 0, and divide it by another.
  return {.value = f.value, .gradient = std::isinf(f.value) ? Vec3d{} : gradient_of(f)};
}

double value(const FieldProgram& program, const Vec3d& p) { return largest_part(program, p).value; }

MaterialWeights material_weights(const FieldProgram& program, const Vec3d& p) {
  const auto [part, tree, value] = largest_part(program, p);
  if (tree != nullptr) return material_weights(*tree, p);
  if (part == nullptr) return {};
  return material_weights(part->blend, part->is_in_world() ? p : part->local_from_world.point(p));
}

HessianJet second_order_value(const FieldProgram& program, const Vec3<HessianJet>& p) {
  const Largest largest = largest_part(program, {p.x.value, p.y.value, p.z.value});
  if (largest.tree != nullptr) return value(*largest.tree, p);
  if (largest.part == nullptr) return {};
  const PlacedBlend& part = *largest.part;
  if (part.is_in_world()) return tree::blend_value(part.blend, p);
  return tree::blend_value(part.blend, AffineWarp{part.world_from_local, part.local_from_world}.child_point(p));
}

bool is_single_blend(const FieldProgram& program) { return program.parts().size() == 1 && program.trees().empty(); }

}  // namespace marrow
