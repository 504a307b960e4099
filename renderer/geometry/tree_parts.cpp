#include "renderer/geometry/tree_parts.h"

#include <cstdint>
#include <utility>

#include "field/blend/blend_field.h"
#include "field/trace/blend_tracer.h"

namespace marrow {
namespace {

constexpr std::size_t most_combined = 256;

// Few skeletons are left to the general tracer, whose hits are exact to 1e-10.
bool is_worth_a_tracer(const BlendField& blend) {
  constexpr std::size_t few = 32;
  return blend.size() >= few && BlendTracer::refusal(blend).empty();
}

}  // namespace

TreeParts take_apart(const FieldTree& tree) {
  TreeParts parts;
  const std::vector<UnionMember> all = members(tree);
  std::vector<std::uint32_t> records, rest;
  for (const UnionMember& member : all) records.push_back(member.record);
  auto expressions = SetExpression::of(tree, records, is_worth_a_tracer);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [record, bounds, is_leaf] = all[i];
    if (expressions[i] && is_finite(bounds.size()) && parts.combined.size() < most_combined)
      parts.combined.push_back({part_of_tree(tree, {{record}}, {}), bounds, std::move(*expressions[i])});
    else rest.push_back(record);
  }
  if (parts.combined.empty()) parts.rest = tree;
  else if (!rest.empty()) parts.rest = part_of_tree(tree, rest, {});
  return parts;
}

}  // namespace marrow
