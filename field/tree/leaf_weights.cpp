// Who contributes how much to the value of a tree at a point.
#include <algorithm>
#include <optional>

#include "field/tree/machine.h"

namespace marrow {
namespace {

// A node as it was visited, after its children.
struct Visit {
  std::uint32_t record;
  Vec3d p;
  double value, weight = 0;
  std::vector<std::size_t> children;  // indices of visits
};

constexpr std::size_t nothing = ~std::size_t{0};

std::vector<double> one_alone(std::size_t one, std::size_t count) {
  std::vector<double> share(count, 0);
  share[one] = 1;
  return share;
}
std::vector<double> largest_alone(std::span<const double> f) {
  return one_alone(static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin()), f.size());
}

std::optional<std::size_t> owner_of(const TreeNode& node, std::span<const double> f) {
  return std::visit(
      [&](const auto& kind) -> std::optional<std::size_t> {
        if constexpr (requires { kind.owner(f); }) return kind.owner(f);
        else return {};
      },
      static_cast<const TreeNode::Kinds&>(node));
}

// On a plateau, or inside a skeleton: the largest operand alone.
std::vector<double> normalised(std::vector<double> share, std::span<const double> f) {
  double total = 0;
  for (const double s : share) total += s;
  if (!(total > 0) || !(total < Box3::inf)) return largest_alone(f);
  for (double& s : share) s /= total;
  return share;
}

// f_i |dF/df_i| of each operand: for each of them all derivatives anew, but where they are known to be 1 or 0.
std::vector<double> shares(const TreeNode& node, std::span<const double> f) {
  if (std::holds_alternative<CrispUnion>(node)) return largest_alone(f);
  if (std::holds_alternative<Sum>(node)) return normalised({f.begin(), f.end()}, f);
  if (const auto owner = owner_of(node, f); owner && f[*owner] > 0) return one_alone(*owner, f.size());
  std::vector<Jet<double, 1>> operands(f.begin(), f.end());
  std::vector<double> share(f.size(), 0);
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (!(f[i] > 0)) continue;
    operands[i].slope[0] = 1;
    const auto F = tree::value_of_node<Jet<double, 1>>(node, {}, operands);
    operands[i].slope[0] = 0;
    share[i] = f[i] * std::fabs(F.slope[0]);
  }
  return normalised(std::move(share), f);
}

}  // namespace

std::vector<LeafWeight> leaf_weights(const FieldTree& tree, const Vec3d& p, std::uint32_t below) {
  std::vector<Visit> visits;
  tree::Machine<double, std::size_t> machine;
  std::vector<double> values;
  machine.run(tree, below, p, nothing,
              [&](std::uint32_t record, const tree::Place<double>& at, std::span<const std::size_t> children) {
                values.clear();
                for (const std::size_t c : children) values.push_back(c == nothing ? 0 : visits[c].value);
                visits.push_back({record,
                                  at.p,
                                  tree::value_of_record<double>(tree, tree.records()[record], at, values),
                                  0,
                                  {children.begin(), children.end()}});
                return visits.size() - 1;
              });
  if (visits.empty() || !(visits.back().value > 0)) return {};
  visits.back().weight = 1;
  std::vector<LeafWeight> leaves;
  for (std::size_t i = visits.size(); i-- > 0;) {
    const Visit& v = visits[i];
    if (!(v.weight > 0)) continue;
    const FieldTree::Record& record = tree.records()[v.record];
    if (v.children.empty()) {
      leaves.push_back({&record, v.weight, v.p});
      continue;
    }
    values.clear();
    for (const std::size_t c : v.children) values.push_back(c == nothing ? 0 : visits[c].value);
    const std::vector<double> share = v.children.size() == 1 ? std::vector{1.0} : shares(tree.node(record), values);
    for (std::size_t c = 0; c < share.size(); ++c)
      if (v.children[c] != nothing) visits[v.children[c]].weight += v.weight * share[c];
  }
  return leaves;
}

MaterialWeights material_weights(const FieldTree& tree, const Vec3d& p, std::uint32_t below) {
  MaterialWeights all;
  for (const LeafWeight& leaf : leaf_weights(tree, p, below)) {
    if (const auto* blend = std::get_if<BlendLeaf>(&tree.node(*leaf.leaf)))
      for (const MaterialWeight& w : material_weights(*blend->field, leaf.local))
        add_weight(all, w.material, leaf.weight * w.weight);
    else add_weight(all, leaf.leaf->material, leaf.weight);
  }
  return all;
}

std::optional<MaterialId> only_material(const FieldTree& tree) {
  std::optional<MaterialId> only;
  bool is_only = true;
  const auto take = [&](MaterialId material) {
    is_only = is_only && material == only.value_or(material);
    only = material;
  };
  for (const FieldTree::Record& record : tree.records()) {
    const TreeNode& node = tree.node(record);
    if (record.child_count > 0 || std::holds_alternative<CrispUnion>(node)) continue;  // a union of nothing is 0
    const auto* blend = std::get_if<BlendLeaf>(&node);
    if (blend == nullptr) take(record.material);
    else
      blend->field->for_each_list([&](const auto& list) {
        for (std::size_t i = 0; i < list.size(); ++i) take(list.material(i));
      });
  }
  return is_only ? only : std::nullopt;
}

MaterialId strongest_material(const FieldTree& tree, const Vec3d& p, std::uint32_t below) {
  return strongest(material_weights(tree, p, below));
}

}  // namespace marrow
