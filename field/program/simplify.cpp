#include "field/program/simplify.h"

#include <cmath>
#include <variant>
#include <vector>

#include "field/tree/any_node.h"

namespace marrow {
namespace {

const AnyNode* general(const FieldNode& node) {
  const auto* g = std::get_if<GeneralNode>(&node.what);
  return g != nullptr && g->node ? &g->node->node : nullptr;
}

// One row for each kind that is one operation however it is bracketed.
template <class Kind>
Absorbs same_operation(const Kind&, const Kind&) {
  return Absorbs::Nothing;
}
Absorbs same_operation(const Sum&, const Sum&) { return Absorbs::Anywhere; }
Absorbs same_operation(const Intersection&, const Intersection&) { return Absorbs::Anywhere; }
Absorbs same_operation(const Ricci& a, const Ricci& b) {
  return a.power == b.power ? Absorbs::Anywhere : Absorbs::Nothing;
}
Absorbs same_operation(const Difference&, const Difference&) { return Absorbs::First; }

template <class Kind>
requires requires(const Kind& k) {
  k.on_first;
  k.on_second;
}
Absorbs same_operation(const Kind& a, const Kind& b) {
  return a.on_first == b.on_first && a.on_second == b.on_second ? Absorbs::First : Absorbs::Nothing;
}
template <class Kind>
requires requires(const Kind& k) { k.smooth; }
Absorbs same_operation(const Kind& a, const Kind& b) {
  return a.smooth == b.smooth ? Absorbs::First : Absorbs::Nothing;
}

}  // namespace

const PointSkeleton* lone_point(const FieldNode& node) {
  const auto* primitive = std::get_if<Primitive>(&node.what);
  if (primitive == nullptr || primitive->model == SkeletonModel::CaniHornus) return nullptr;
  return std::get_if<PointSkeleton>(&primitive->skeleton);
}

std::optional<Affine> placement_of(const GeneralNode& node) {
  constexpr double most = 100;
  if (const auto* shear = std::get_if<Shear>(&node.node->node); shear != nullptr && std::fabs(shear->amount) <= most)
    return shear->parent_from_child();
  if (const auto* taper = std::get_if<Taper>(&node.node->node);
      taper != nullptr && taper->start == taper->end && 1 / most <= taper->start && taper->start <= most)
    return taper->parent_from_child();
  return std::nullopt;
}

Absorbs absorbs(const FieldNode& parent, const FieldNode& child) {
  if (std::holds_alternative<Union>(parent.what) && std::holds_alternative<Union>(child.what)) return Absorbs::Anywhere;
  const AnyNode *a = general(parent), *b = general(child);
  if (a == nullptr || b == nullptr || a->index() != b->index()) return Absorbs::Nothing;
  return std::visit([&]<class Kind>(const Kind& kind) { return same_operation(kind, std::get<Kind>(*b)); }, *a);
}

std::optional<Blend> sum_of_points(const FieldDescription& field, FieldNodeId root) {
  Blend blend;
  blend.alpha = AlphaSum{};
  std::vector<FieldNodeId> open{root};
  while (!open.empty()) {
    const FieldNodeId id = open.back();
    open.pop_back();
    FieldNodeId placed = id;
    while (const auto* map = std::get_if<Transform>(&field[placed].what)) {
      if (!map->parent_from_child.similarity()) return std::nullopt;
      placed = map->of;
    }
    const AnyNode* node = general(field[id]);
    if (lone_point(field[placed]) != nullptr) blend.of.push_back(id);
    else if (node == nullptr || !std::holds_alternative<Sum>(*node)) return std::nullopt;
    else {
      const auto& of = std::get<GeneralNode>(field[id].what).of;
      open.insert(open.end(), of.rbegin(), of.rend());
    }
    if (blend.of.size() + open.size() > max_points_of_sum) return std::nullopt;
  }
  return blend.of.size() < 2 ? std::nullopt : std::optional(std::move(blend));
}

}  // namespace marrow
