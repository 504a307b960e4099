#include "field/tree/blend_in_tree.h"

#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "field/blend/bounds/blend_bounds.h"
#include "field/number/places_in.h"
#include "field/tree/machine.h"

namespace marrow {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Where a blend is to be asked for by less than this, cells and questions cost more than they save.
constexpr double least_decided = 0.5;
// Halvings of the bounds until which it is looked for what is decided: 4096 boxes, some microseconds each.
constexpr int deepest = 4;

struct Leaf {
  std::uint32_t record;
  Affine tree_from_blend;
};

// From the leaf up to the root, each record the child of one other, once.
std::optional<Affine> way_up(const FieldTree& tree, std::uint32_t leaf) {
  constexpr std::uint32_t several = FieldTree::whole - 1;
  std::vector<std::uint32_t> parent(tree.records().size(), FieldTree::whole);
  for (std::uint32_t i = 0; i < parent.size(); ++i)
    for (const std::uint32_t child : tree.children(tree.records()[i]))
      parent[child] = parent[child] == FieldTree::whole ? i : several;
  Affine map;
  for (std::uint32_t at = leaf; at != tree.root();) {
    at = parent[at];
    if (at == several || at == FieldTree::whole) return {};
    const bool is_in_place = std::visit(
        [&]<class Node>(const Node& node) {
          if constexpr (std::same_as<Node, AffineWarp>) map = node.parent_from_child * map;
          return std::same_as<Node, AffineWarp> || tree::Operator<Node, double>;
        },
        tree.node(tree.records()[at]));
    if (!is_in_place) return {};
  }
  return map;
}

std::optional<Leaf> largest_leaf(const FieldTree& tree, const std::function<bool(const BlendField&)>& wanted) {
  std::optional<std::uint32_t> leaf;
  std::size_t most = 0;
  for (std::uint32_t i = 0; i < tree.records().size(); ++i) {
    const auto* blend = std::get_if<BlendLeaf>(&tree.node(tree.records()[i]));
    if (blend == nullptr || blend->field->size() <= most || !wanted(*blend->field)) continue;
    most = blend->field->size();
    leaf = i;
  }
  if (!leaf) return {};
  const auto map = way_up(tree, *leaf);
  return map ? std::optional(Leaf{*leaf, *map}) : std::nullopt;
}

// No direction is stretched more.
double most_stretch(const Affine& map) {
  const auto& [x, y, z] = map.columns;
  return std::sqrt(dot(x, x) + dot(y, y) + dot(z, z));
}

double volume(const Box3& box) {
  const Vec3d size = box.size();
  return size.x * size.y * size.z;
}

std::array<Box3, 8> octants(const Box3& box) {
  std::array<Box3, 8> all;
  const Vec3d middle = box.center();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_upper = (i >> axis & 1) != 0;
      all[i].lower[axis] = is_upper ? middle[axis] : box.lower[axis];
      all[i].upper[axis] = is_upper ? box.upper[axis] : middle[axis];
    }
  return all;
}

}  // namespace

std::shared_ptr<const BlendInTree> BlendInTree::of(const FieldTree& tree,
                                                   const std::function<bool(const BlendField&)>& wanted) {
  const auto leaf = largest_leaf(tree, wanted);
  if (!leaf || leaf->record == tree.root()) return nullptr;
  const auto& blend = std::get<BlendLeaf>(tree.node(tree.records()[leaf->record])).field;
  std::shared_ptr<BlendInTree> made(new BlendInTree(tree, leaf->record, blend, leaf->tree_from_blend));
  if (!is_finite(made->bounds_.size()) || made->bounds_.empty()) return nullptr;
  made->find_undecided();
  return made->decided_ < least_decided ? nullptr : made;
}

// Fields are off by 1e-5 over n - 1 of a radius; a thousandth of it costs nothing.
BlendInTree::BlendInTree(FieldTree tree, std::uint32_t leaf, std::shared_ptr<const BlendField> blend,
                         const Affine& tree_from_blend)
    : tree_(std::move(tree)),
      leaf_(leaf),
      blend_(std::move(blend)),
      tree_from_blend_(tree_from_blend),
      bounds_(surface_bounds(tree_)),
      decided_(0),
      beside_(1e-3 * largest_radius(*blend_) * most_stretch(tree_from_blend)) {
  bounds_.include(tree_from_blend_.box_around(blend_extent(*blend_, 1)));
}

void BlendInTree::find_undecided() {
  const Box3 of_blend = tree_from_blend_.box_around(blend_extent(*blend_, 1));
  std::vector<std::pair<Box3, int>> open{{bounds_, 0}};
  double left = 0;
  while (!open.empty()) {
    const auto [box, depth] = open.back();
    open.pop_back();
    if (asked(box) == true) continue;
    if (depth == deepest) {
      undecided_.include(box);
      if (const Box3 shared = common(box, of_blend); !shared.empty()) left += volume(shared);
      continue;
    }
    for (const Box3& octant : octants(box)) open.push_back({octant, depth + 1});
  }
  decided_ = 1 - left / volume(of_blend);
}

// The field of the whole in a box, with that of the blend given.
class BlendInTree::Asked {
 public:
  Asked(const BlendInTree& of, const Box3& box) : of_(of), p_(places_in(box)) { leaves().clear(); }
  Interval field(const Interval& of_blend) {
    thread_local tree::Machine<Interval, Interval> machine;
    std::size_t next = 0;
    return machine.run(of_.tree_, FieldTree::whole, p_, Interval(0),
                       [&](std::uint32_t record, const tree::Place<Interval>& at, std::span<const Interval> children) {
                         if (record == of_.leaf_) return of_blend;
                         const FieldTree::Record& r = of_.tree_.records()[record];
                         if (!children.empty()) return tree::value_of_record(of_.tree_, r, at, children);
                         // Trees are gone through in one order, whatever the fields are.
                         if (next == leaves().size())
                           leaves().push_back(tree::value_of_record(of_.tree_, r, at, children));
                         return leaves()[next++];
                       });
  }

 private:
  // Those of the other leaves, which are found once.
  static std::vector<Interval>& leaves() {
    thread_local std::vector<Interval> values;
    return values;
  }

  const BlendInTree& of_;
  Vec3<Interval> p_;
};

std::optional<bool> BlendInTree::asked(const Box3& box) const {
  Asked whole(*this, box);
  if (!whole.field({1 - tolerance, 1 + tolerance}).contains(1)) return false;
  if (whole.field({0, 1 - tolerance}).hi < 1 && whole.field({1 + tolerance, infinity}).lo > 1) return true;
  return {};
}

std::optional<bool> BlendInTree::decides(const Box3& box) const {
  if (bounds_.contains(box.lower) && bounds_.contains(box.upper) && !do_overlap(box, undecided_)) return true;
  return asked(box);
}

bool BlendInTree::decides_around(const Box3& box) const { return decides(box.padded(beside_)) == true; }

Side BlendInTree::side(const Box3& box, Side of_blend) const {
  const Interval f =
      Asked(*this, box).field({of_blend == Side::Inside ? 1.0 : 0.0, of_blend == Side::Outside ? 1.0 : infinity});
  if (f.hi < 1) return Side::Outside;
  return f.lo > 1 ? Side::Inside : Side::Unknown;
}

}  // namespace marrow
