#include "renderer/geometry/tree_parts.h"

#include <cstdint>
#include <utility>

#include "field/blend/blend_field.h"
#include "field/trace/blend_tracer.h"

namespace marrow {
namespace {

constexpr std::size_t most_combined = 256;

// Of few skeletons the general tracer sees as much.
bool is_worth_a_tracer(const BlendField& blend) {
  constexpr std::size_t few = 32;
  return blend.size() >= few && BlendTracer::refusal(blend).empty();
}

}  // namespace

TreeParts take_apart(const FieldTree& tree) {
  TreeParts parts;
  std::vector<std::uint32_t> rest;
  const std::vector<Member> all = members(tree);
  for (const Member& member : all) {
    std::optional<SetExpression> expression;
    if (is_finite(member.bounds.size()) && parts.combined.size() < most_combined)
      expression = SetExpression::of(tree, member.record, is_worth_a_tracer);
    if (!expression) rest.push_back(member.record);
    else parts.combined.push_back({part_of_tree(tree, {{member.record}}, {}), member.bounds, std::move(*expression)});
  }
  if (rest.size() == all.size()) parts.rest = tree;
  else if (!rest.empty()) parts.rest = part_of_tree(tree, rest, {});
  return parts;
}

}  // namespace marrow
