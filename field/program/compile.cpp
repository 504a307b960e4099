// Walks a description from its root with a stack of placements; no recursion, so no depth limit.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "field/base/overloaded.h"
#include "field/program/contact_angles.h"
#include "field/program/crisp_surface.h"
#include "field/program/field_program.h"
#include "field/program/flattener.h"
#include "field/program/ramped_field.h"
#include "field/program/simplify.h"
#include "field/program/tree_builder.h"
#include "field/program/validate.h"
#include "field/tree/tree_node.h"

namespace marrow {
namespace {

// A description may place one node many times; with this many more placements than nodes something is wrong.
constexpr std::size_t max_shared_placements = 1'000'000;

// Each blend has a tracer of its own, which takes milliseconds and some hundred kilobytes. Where a union has more
// blends of a few skeletons than this, they become leaves of a tree, whose tracer takes each as it is.
constexpr std::ptrdiff_t few_blends = 1000;

struct Placement {
  FieldNodeId node;
  Affine from_node;  // to the world, or to the blend
};

class Compiler {
 public:
  explicit Compiler(const FieldDescription& description)
      : description_(description), max_placements_(description.nodes.size() + max_shared_placements) {}

  /// Precondition: the description is valid.
  Result<FieldProgram> run() {
    find_shared();
    return run_from({description_.root, Affine{}});
  }

 private:
  Result<FieldProgram> run_from(const Placement& root) {
    const std::vector<Placement> fields = fields_of(root);
    const auto is_small = [&](const Placement& p) { return is_small_blend(p.node); };
    const auto small = std::count_if(fields.begin(), fields.end(), is_small);
    const bool scattered = small > few_blends;
    std::vector<Placement> in_tree;
    for (const Placement& here : fields) {
      const bool is_leaf = scattered && is_small(here);
      if (is_leaf || !add_as_part(here)) in_tree.push_back(here);
    }
    if (!in_tree.empty() && placements_ <= max_placements_) add_tree(in_tree);
    if (placements_ > max_placements_)
      report(root.node, "the field holds over a million copies of its own nodes", "place fewer copies inside copies");
    if (!errors_.empty()) return errors_;
    return FieldProgram(std::move(parts_), std::move(trees_), std::move(warnings_));
  }

  // What the field is the union of, in its order.
  std::vector<Placement> fields_of(const Placement& root) {
    std::vector<Placement> open{root}, fields;
    while (!open.empty() && placements_ <= max_placements_) {
      const Placement here = open.back();
      open.pop_back();
      ++placements_;
      std::visit(Overloaded{[&](const Union& u) { push_children(u.of, here.from_node, open); },
                            [&](const Transform& t) {
                              open.push_back({t.of, here.from_node * t.parent_from_child});
                            },
                            [&](const GeneralNode& n) {
                              if (const auto map = placement_of(n)) open.push_back({n.of[0], here.from_node * *map});
                              else fields.push_back(here);
                            },
                            [&](const auto&) { fields.push_back(here); }},
                 description_[here.node].what);
    }
    return fields;
  }

  // Of up to four skeletons, none of which is a line or graph of many.
  bool is_small_blend(FieldNodeId id) const {
    const FieldNode& node = description_[id];
    if (const auto* primitive = std::get_if<Primitive>(&node.what))
      return !std::holds_alternative<PolylineSkeleton>(primitive->skeleton) &&
             !std::holds_alternative<CurveSkeleton>(primitive->skeleton) &&
             !std::holds_alternative<SharedSkeletonGraph>(primitive->skeleton);
    const auto* blend = std::get_if<Blend>(&node.what);
    return blend != nullptr && blend->of.size() <= 4 &&
           std::all_of(blend->of.begin(), blend->of.end(), [&](auto child) {
             return std::holds_alternative<Primitive>(description_[child].what) && is_small_blend(child);
           });
  }

  // False: it belongs into the tree.
  bool add_as_part(const Placement& here) {
    const FieldNode& node = description_[here.node];
    if (const auto* blend = std::get_if<Blend>(&node.what)) parts_.push_back(part_of(*blend, here));
    else if (const auto* p = std::get_if<Primitive>(&node.what))
      parts_.push_back(part_of(blend_of_one(here.node), here, p->model));
    else if (const auto sum = sum_of_points(description_, here.node)) parts_.push_back(part_of(*sum, here));
    else return false;
    return true;
  }

  // The last child first, so that the stack gives them in their order.
  static void push_children(const std::vector<FieldNodeId>& children, const Affine& map, std::vector<Placement>& open) {
    for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back({*child, map});
  }

  // Which nodes are placed more than once, by two parents or by one that is, or by other fields. Parents stand behind
  // their children.
  void find_shared() {
    shared_.resize(description_.nodes.size());
    for (std::size_t i = 0; i < shared_.size(); ++i) shared_[i] = description_.nodes[i].shared != 0;
    std::vector<bool> seen(description_.nodes.size(), false);
    for (std::size_t i = description_.nodes.size(); i-- > 0;) {
      const auto place = [&](FieldNodeId child) {
        if (seen[child.index()] || shared_[i]) shared_[child.index()] = true;
        seen[child.index()] = true;
      };
      std::visit(Overloaded{[](const Primitive&) {}, [&](const Transform& t) { place(t.of); },
                            [&](const auto& group) { std::for_each(group.of.begin(), group.of.end(), place); }},
                 description_.nodes[i].what);
    }
  }

  void report(FieldNodeId node, std::string message, std::string hint) {
    if (!reported_.insert(node).second) return;
    errors_.push_back({.where = description_[node].where, .message = std::move(message), .hint = std::move(hint)});
  }

  BlendField empty_field(const Blend& blend) {
    BlendField field;
    field.degree = blend.kernel.degree;
    field.kernel = blend.kernel.family;
    field.kernel_shape = blend.kernel.shape;
    field.alpha =
        std::visit(Overloaded{[](AlphaSum) { return std::numbers::pi / 2; }, [](double radians) { return radians; },
                              [](const AlphaDirection& d) { return d.most; },
                              [&](const auto&) { return contact_.of(blend).alpha; }},
                   blend.alpha);
    field.alpha_per_skeleton =
        std::holds_alternative<AlphaPerSkeleton>(blend.alpha) || std::holds_alternative<AlphaAttribute>(blend.alpha);
    if (const auto* rule = std::get_if<AlphaLocalContact>(&blend.alpha))
      field.local_contact = contact_.local(blend, *rule);
    field.cavity = blend.cavity;
    field.projection = blend.projection;
    return field;
  }

  void warn(FieldNodeId node, std::string message, std::string hint) {
    if (!warned_.insert(node).second) return;
    warnings_.push_back({.where = description_[node].where,
                         .message = std::move(message),
                         .hint = std::move(hint),
                         .severity = Severity::Warning});
  }

  // What a kernel that is finite on its skeletons cannot keep.
  void warn_of_bounded_kernel(const Blend& blend, const BlendField& field, FieldNodeId node) {
    const Correction correction = correction_of(field);
    if (!correction.bounded() || std::holds_alternative<AlphaSum>(blend.alpha)) return;
    const std::string narrower =
        blend.kernel.family == KernelFamily::Cauchy ? "a larger `scale`" : "a smaller `support`";
    if (!correction.bounded()->solid_alone())
      warn(node, "skeletons of this kernel are hollow with this alpha", "use " + narrower + ", or a larger alpha");
    else if (std::holds_alternative<AlphaContact>(blend.alpha) && !contact_.of(blend).is_exact)
      warn(node, "skeletons of this kernel join before they touch, or would be hollow, whatever alpha",
           "use " + narrower);
  }

  PlacedBlend part_of(const Blend& blend, const Placement& here, std::optional<SkeletonModel> model = {}) {
    PlacedBlend part;
    part.blend = empty_field(blend);
    warn_of_bounded_kernel(blend, part.blend, here.node);
    const bool shared = !shared_.empty() && shared_[here.node.index()];
    if (shared) part.shape = here.node.index() + 1;
    if (shared) part.shared = description_[here.node].shared;
    const bool baked = !shared && here.from_node.similarity().has_value();
    if (!baked) {
      part.world_from_local = here.from_node;
      part.local_from_world = here.from_node.inverse();
    }
    const Affine to_blend = baked ? here.from_node : Affine{};
    if (const auto* rule = std::get_if<AlphaFromField>(&blend.alpha))
      part.blend.alpha_source = source_of(*rule, {rule->field, to_blend});
    strand_ = 0;
    has_attribute_ = false;
    std::vector<Placement> open;
    push_children(blend.of, to_blend, open);
    while (!open.empty() && placements_ <= max_placements_) {
      const Placement child = open.back();
      open.pop_back();
      ++placements_;
      add_child(child, blend, model.value_or(blend.model), part.blend, open);
    }
    if (const auto* rule = std::get_if<AlphaAttribute>(&blend.alpha); rule && !has_attribute_)
      warn(here.node, "no skeleton of this blend has the attribute `" + rule->name + "`",
           "each has the angle of `contact` then");
    return part;
  }

  // All that is no part, under one union: a node that it places more than once is held once.
  void add_tree(const std::vector<Placement>& fields) {
    TreeBuilder builder(description_, [this](const Blend& blend, FieldNodeId id) { return leaf_of(blend, id); });
    std::vector<FieldNodeId> roots;
    for (const Placement& here : fields)
      if (lone_point(description_[here.node]) == nullptr) roots.push_back(here.node);
    builder.read(roots);
    for (const Placement& here : fields) {
      const PointSkeleton* point = lone_point(description_[here.node]);
      const auto scale = point != nullptr ? here.from_node.similarity() : std::nullopt;
      if (!scale) builder.place(here.node, here.from_node);
      else
        builder.place(PointLeaf{here.from_node.point(point->at), point->radius * *scale}, Affine{},
                      std::get<Primitive>(description_[here.node].what).material);
    }
    if (builder.visits() > static_cast<double>(max_placements_)) placements_ = max_placements_ + 1;
    else trees_.push_back(std::move(builder).tree());
  }

  BlendLeaf leaf_of(const Blend& blend, FieldNodeId id) {
    std::optional<SkeletonModel> model;
    if (const auto* primitive = std::get_if<Primitive>(&description_[id].what)) model = primitive->model;
    return {std::make_shared<BlendField>(part_of(blend, {id, Affine{}}, model).blend)};
  }

  // The field of angles of a blend, which is placed with it.
  std::shared_ptr<const AlphaSource> source_of(const AlphaFromField& rule, const Placement& place) {
    if (is_source_) {
      report(place.node, "an alpha from a field, within the field of another alpha", "one field may steer a blend");
      return nullptr;
    }
    Compiler inner(description_);
    inner.is_source_ = true;
    inner.placements_ = placements_;  // one budget for all
    auto program = inner.run_from(place);
    placements_ = inner.placements_;
    if (program) return std::make_shared<RampedField>(*std::move(program), rule.ramp);
    errors_.insert(errors_.end(), program.why().begin(), program.why().end());
    return nullptr;
  }

  void add_child(const Placement& child, const Blend& blend, SkeletonModel model, BlendField& field,
                 std::vector<Placement>& open) {
    std::visit(
        Overloaded{[&](const Primitive& p) { add_primitive(p, child, blend, model, field); },
                   [&](const Transform& t) {
                     if (!t.parent_from_child.similarity())
                       return report(child.node, "a transform inside a blend that changes shape",
                                     "inside a blend move, rotate and scale uniformly; "
                                     "or put the transform above the blend");
                     open.push_back({t.of, child.from_node * t.parent_from_child});
                   },
                   [&](const Union& u) {
                     if (u.is_group) push_children(u.of, child.from_node, open);
                     else report_nesting(child.node, "union");
                   },
                   [&](const Blend&) { report_nesting(child.node, "blend"); },
                   [&](const GeneralNode& n) { report_nesting(child.node, std::string(info_of(n.node->node).name)); }},
        description_[child.node].what);
  }

  void report_nesting(FieldNodeId node, const std::string& kind) {
    report(node, "a " + kind + " inside a blend is not supported",
           "a blend takes skeletons (point, segment, polyline, curve, triangle, circle, arc, skeleton), transforms and "
           "groups of them; `sum`, `ricci` or `soft_union` blend whole fields");
  }

  void add_primitive(const Primitive& primitive, const Placement& child, const Blend& blend, SkeletonModel model,
                     BlendField& field) {
    // Each map on the way is a similarity, so that any column has the scale of all together.
    const double scale = length(child.from_node.columns[0]);
    if (const auto* rule = std::get_if<AlphaDirection>(&blend.alpha)) {
      const auto [least, most] = primitive.alpha_bounds.value_or(std::array{rule->least, rule->most});
      field.direction_bounds.push_back({least, most});
    }
    if (const auto* rule = std::get_if<AlphaAttribute>(&blend.alpha))
      has_attribute_ = has_attribute_ || has_attribute(primitive, rule->name);
    else if (primitive.alpha && !std::holds_alternative<AlphaPerSkeleton>(blend.alpha))
      warn(child.node, "the `alpha` of this skeleton has no effect", "give its blend `alpha: per_skeleton`");
    Flattener flatten(field, child.from_node, scale, model, primitive, blend.alpha, strand_++);
    std::visit(flatten, primitive.skeleton);
    if (flatten.model() == SkeletonModel::CaniHornus) {
      if (std::holds_alternative<TriangleSkeleton>(primitive.skeleton) ||
          std::holds_alternative<ArcSkeleton>(primitive.skeleton))
        report(child.node, "`model: cani_hornus` is not there for triangles, circles and arcs",
               "say `model: integral` here");
      else if (field.kernel != KernelFamily::Inverse || field.degree != 3)
        report(child.node, "`model: cani_hornus` is an integral of 1/r^3", "give the blend `kernel: {inverse: 3}`");
    }
    const bool is_any_angle_defined = field.projection == Projection::Paper && field.kernel == KernelFamily::Inverse;
    const double least = primitive.alpha_bounds ? std::min((*primitive.alpha_bounds)[0], (*primitive.alpha_bounds)[1])
                                                : primitive.alpha.value_or(0);
    if (field.alpha_varies() && least < 0 && !is_any_angle_defined)
      report(child.node, "an alpha below 0 with this kernel or projection",
             "below alpha = 0 only the kernel `inverse` with `projection: paper` is defined");
    if (flatten.without_length() > 0)
      warn(child.node,
           flatten.without_length() == 1 ? "a segment has no length"
                                         : std::to_string(flatten.without_length()) + " segments have no length",
           "a segment without length adds nothing; use a point for a ball");
  }

  const FieldDescription& description_;
  std::set<FieldNodeId> reported_, warned_;
  std::vector<bool> shared_;  // see find_shared(); empty in a compiler of a subtree
  std::vector<PlacedBlend> parts_;
  std::vector<FieldTree> trees_;
  Diagnostics errors_, warnings_;
  ContactAngles contact_;
  std::size_t placements_ = 0, max_placements_;
  std::uint32_t strand_ = 0;    // of the blend in hand
  bool has_attribute_ = false;  // a skeleton of it, that of its alpha
  bool is_source_ = false;      // a field of angles, within another compilation
};

}  // namespace

Result<FieldProgram> compile(const FieldDescription& description) {
  if (Diagnostics wrong = validate(description); !wrong.empty()) return wrong;
  return Compiler(description).run();
}

Result<FieldProgram> compile_surface(const FieldDescription& description) {
  if (Diagnostics wrong = validate(description); !wrong.empty()) return wrong;
  const auto crisp = crisp_surface(description);
  return Compiler(crisp ? *crisp : description).run();
}

}  // namespace marrow
