// Walks a description from its root with a stack of placements; no recursion, so no depth limit.
#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "field/base/overloaded.h"
#include "field/blend/contact.h"
#include "field/program/field_program.h"
#include "field/program/validate.h"
#include "field/skeleton/subdivision_curve.h"

namespace marrow {
namespace {

// A description may place one node many times; with this many more placements than nodes something is wrong.
constexpr std::size_t max_shared_placements = 1'000'000;

struct Placement {
  FieldNodeId node;
  Affine from_node;  // to the world, or to the blend
};

// contact_alpha() takes some microseconds, too many for each of 10^5 blends alike.
class ContactAngles {
 public:
  double of(const Blend& blend) {
    const Key key{blend.kernel.degree, blend.cavity, blend.projection};
    const auto known = angles_.find(key);
    if (known != angles_.end()) return known->second;
    return angles_[key] = std::apply(contact_alpha, key);
  }

 private:
  using Key = std::tuple<int, bool, Projection>;
  std::map<Key, double> angles_;
};

// A primitive alone is a blend of one with the defaults.
Blend blend_of(FieldNodeId primitive) {
  Blend blend;
  blend.of = {primitive};
  return blend;
}

// Adds the skeleton of one primitive to a blend, mapped by a similarity.
class Flattener {
 public:
  Flattener(BlendField& field, const Affine& map, double scale, SkeletonModel model, const Primitive& primitive)
      : field_(field),
        map_(map),
        scale_(scale),
        model_(primitive.model.value_or(model)),
        material_(primitive.material),
        alpha_(primitive.alpha.value_or(field.alpha)) {}

  void operator()(const PointSkeleton& s) { add(field_.points, PointSkeleton{map_.point(s.at), s.radius * scale_}); }

  // A segment of no length has no integral; its scaled distance is that of its larger end.
  void operator()(const SegmentSkeleton& s) {
    if (model_ == SkeletonModel::Distance && !(length(s.to - s.from) > 0))
      (*this)(PointSkeleton{s.from, std::max(s.radius_from, s.radius_to)});
    else add_segment(s.from, s.to, s.radius_from, s.radius_to);
  }

  void operator()(const PolylineSkeleton& s) {
    segments().skeletons.reserve(segments().size() + s.points.size());
    for (std::size_t i = 1; i < s.points.size(); ++i)
      add_segment(s.points[i - 1], s.points[i], s.radii[i - 1], s.radii[i]);
  }

  void operator()(const CurveSkeleton& s) { (*this)(subdivide(s)); }

  void operator()(const SharedSkeletonGraph& shared) {
    const SkeletonGraph& s = *shared;
    const std::size_t count = s.positions.size();
    segments().skeletons.reserve(segments().size() + count);
    std::vector<bool> has_child(count, false);
    for (const std::int32_t parent : s.parents)
      if (parent != SkeletonGraph::no_parent) has_child[static_cast<std::size_t>(parent)] = true;
    for (std::size_t i = 0; i < count; ++i) {
      if (s.parents[i] != SkeletonGraph::no_parent) {
        const auto parent = static_cast<std::size_t>(s.parents[i]);
        add_segment(s.positions[parent], s.positions[i], s.radii[parent], s.radii[i]);
      } else if (!has_child[i]) {
        (*this)(PointSkeleton{s.positions[i], s.radii[i]});
      }
    }
  }

  void operator()(const TriangleSkeleton& s) {
    TriangleSkeleton mapped = s;
    for (Vec3d& vertex : mapped.vertices) vertex = map_.point(vertex);
    for (double& radius : mapped.radii) radius *= scale_;
    add(field_.triangles, mapped);
  }

  void operator()(const ArcSkeleton& s) {
    ArcSkeleton mapped = s;
    mapped.center = map_.point(s.center);
    mapped.axis1 = map_.vector(s.axis1) / scale_;
    mapped.axis2 = map_.vector(s.axis2) / scale_;
    mapped.major *= scale_;
    mapped.radius_from *= scale_;
    mapped.radius_to *= scale_;
    add(field_.arcs, mapped);
  }

  SkeletonModel model() const { return model_; }
  std::size_t without_length() const { return without_length_; }

 private:
  template <class Skeleton>
  void add(PrimitiveList<Skeleton>& list, const Skeleton& mapped) {
    list.add(mapped, material_);
    if (field_.alpha_per_skeleton) list.alphas.push_back(alpha_);
  }
  PrimitiveList<SegmentSkeleton>& segments() {
    return model_ == SkeletonModel::Distance ? field_.distance_segments : field_.segments;
  }
  void add_segment(const Vec3d& from, const Vec3d& to, double radius_from, double radius_to) {
    const SegmentSkeleton mapped{map_.point(from), map_.point(to), radius_from * scale_, radius_to * scale_};
    if (length(mapped.to - mapped.from) > 0) add(segments(), mapped);
    else ++without_length_;
  }

  BlendField& field_;
  const Affine& map_;
  double scale_;
  SkeletonModel model_;
  MaterialId material_;
  double alpha_;
  std::size_t without_length_ = 0;
};

class Compiler {
 public:
  explicit Compiler(const FieldDescription& description)
      : description_(description),
        reported_(description.nodes.size(), false),
        max_placements_(description.nodes.size() + max_shared_placements) {}

  Result<FieldProgram> run() {
    if (Diagnostics wrong = validate(description_); !wrong.empty()) return wrong;
    find_shared();
    std::vector<Placement> open{{description_.root, Affine{}}};
    while (!open.empty() && placements_ <= max_placements_) {
      const Placement here = open.back();
      open.pop_back();
      ++placements_;
      std::visit(Overloaded{[&](const Union& u) { push_children(u.of, here.from_node, open); },
                            [&](const Transform& t) {
                              open.push_back({t.of, here.from_node * t.parent_from_child});
                            },
                            [&](const Blend& b) { add_part(b, here); },
                            [&](const Primitive& p) { add_part(blend_of(here.node), here, p.model); }},
                 description_[here.node].what);
    }
    if (placements_ > max_placements_)
      report(description_.root, "the field holds over a million copies of its own nodes",
             "place fewer copies inside copies");
    if (!errors_.empty()) return errors_;
    return FieldProgram(std::move(parts_), std::move(warnings_));
  }

 private:
  // The last child first, so that the stack gives them in their order.
  static void push_children(const std::vector<FieldNodeId>& children, const Affine& map, std::vector<Placement>& open) {
    for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back({*child, map});
  }

  // Which nodes are placed more than once, by two parents or by one that is. Parents stand behind their children.
  void find_shared() {
    shared_.assign(description_.nodes.size(), false);
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
    if (reported_[node.index()]) return;
    reported_[node.index()] = true;
    errors_.push_back({.where = description_[node].where, .message = std::move(message), .hint = std::move(hint)});
  }

  BlendField empty_field(const Blend& blend) {
    BlendField field;
    field.degree = blend.kernel.degree;
    field.kernel = blend.kernel.family;
    field.kernel_shape = blend.kernel.shape;
    field.alpha =
        std::visit(Overloaded{[&](AlphaContact) { return contact_.of(blend); },
                              [&](AlphaPerSkeleton) { return contact_.of(blend); },
                              [](AlphaSum) { return std::numbers::pi / 2; }, [](double radians) { return radians; }},
                   blend.alpha);
    field.alpha_per_skeleton = std::holds_alternative<AlphaPerSkeleton>(blend.alpha);
    field.cavity = blend.cavity;
    field.projection = blend.projection;
    return field;
  }

  void add_part(const Blend& blend, const Placement& here, std::optional<SkeletonModel> model = {}) {
    PlacedBlend part;
    part.blend = empty_field(blend);
    const bool shared = !shared_.empty() && shared_[here.node.index()];
    if (shared) part.shape = here.node.index() + 1;
    const bool baked = !shared && here.from_node.similarity().has_value();
    if (!baked) {
      part.world_from_local = here.from_node;
      part.local_from_world = here.from_node.inverse();
    }
    const Affine to_blend = baked ? here.from_node : Affine{};
    std::vector<Placement> open;
    push_children(blend.of, to_blend, open);
    while (!open.empty() && placements_ <= max_placements_) {
      const Placement child = open.back();
      open.pop_back();
      ++placements_;
      add_child(child, model.value_or(blend.model), part.blend, open);
    }
    parts_.push_back(std::move(part));
  }

  void add_child(const Placement& child, SkeletonModel model, BlendField& field, std::vector<Placement>& open) {
    std::visit(Overloaded{[&](const Primitive& p) { add_primitive(p, child, model, field); },
                          [&](const Transform& t) {
                            if (!t.parent_from_child.similarity())
                              return report(child.node, "a transform inside a blend that changes shape",
                                            "inside a blend move, rotate and scale uniformly; "
                                            "or put the transform above the blend");
                            open.push_back({t.of, child.from_node * t.parent_from_child});
                          },
                          [&](const Union&) { report_nesting(child.node, "union"); },
                          [&](const Blend&) { report_nesting(child.node, "blend"); }},
               description_[child.node].what);
  }

  void report_nesting(FieldNodeId node, const std::string& kind) {
    report(node, "a " + kind + " inside a blend is not supported",
           "a blend takes skeletons (point, segment, polyline, skeleton), or transforms of them");
  }

  void add_primitive(const Primitive& primitive, const Placement& child, SkeletonModel model, BlendField& field) {
    // Each map on the way is a similarity, so that any column has the scale of all together.
    const double scale = length(child.from_node.columns[0]);
    Flattener flatten(field, child.from_node, scale, model, primitive);
    std::visit(flatten, primitive.skeleton);
    const bool is_integral_only = std::holds_alternative<TriangleSkeleton>(primitive.skeleton) ||
                                  std::holds_alternative<ArcSkeleton>(primitive.skeleton);
    if (is_integral_only && flatten.model() == SkeletonModel::Distance)
      report(child.node, "`model: distance` is not there for triangles, circles and arcs",
             "say `model: integral` here");
    const bool is_inverse_only = is_integral_only || (flatten.model() == SkeletonModel::Distance &&
                                                      !std::holds_alternative<PointSkeleton>(primitive.skeleton));
    if (is_inverse_only && field.kernel != KernelFamily::Inverse)
      report(child.node, "this skeleton is not there for the kernels cauchy and compact",
             "they take points and, with `model: integral`, segments, polylines, curves and skeletons");
    if (field.alpha_per_skeleton && field.projection == Projection::Exact && primitive.alpha && *primitive.alpha < 0)
      report(child.node, "an alpha below 0 with the exact projection",
             "below alpha = 0 only `projection: paper` is defined");
    if (flatten.without_length() == 0 || reported_[child.node.index()]) return;
    reported_[child.node.index()] = true;
    warnings_.push_back({.where = description_[child.node].where,
                         .message = std::to_string(flatten.without_length()) + " segments have no length",
                         .hint = "a segment without length adds nothing; use a point for a ball",
                         .severity = Severity::Warning});
  }

  const FieldDescription& description_;
  std::vector<bool> reported_, shared_;
  std::vector<PlacedBlend> parts_;
  Diagnostics errors_, warnings_;
  ContactAngles contact_;
  std::size_t placements_ = 0, max_placements_;
};

}  // namespace

Result<FieldProgram> compile(const FieldDescription& description) { return Compiler(description).run(); }

}  // namespace marrow
