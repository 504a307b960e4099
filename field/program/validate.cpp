// One check for each kind of node.
#include "field/program/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "field/base/overloaded.h"
#include "field/base/result.h"
#include "field/blend/angle/local_contact.h"
#include "field/kernel/inverse_family.h"
#include "field/program/node_angles.h"
#include "field/program/validate_node.h"
#include "field/skeleton/subdivision_curve.h"

namespace marrow {
namespace {

constexpr double smallest_alpha = -1, largest_alpha = std::numbers::pi / 2;

// Collects what is wrong at one place of the text.
class Findings {
 public:
  Findings(const SourceLocation& where, Diagnostics& all) : where_(where), all_(all) {}

  void add(std::string message, std::string hint) {
    all_.push_back({.where = where_, .message = std::move(message), .hint = std::move(hint)});
  }
  void check_positions(std::span<const Vec3d> positions) {
    for (const Vec3d& p : positions)
      if (!is_finite(p)) return add("a position is not finite", "coordinates are finite numbers");
  }
  // Powers up to the degree of the kernel, at most 20, must stay numbers.
  void check_radii(std::span<const double> radii) {
    constexpr double smallest = 1e-15;
    for (std::size_t i = 0; i < radii.size(); ++i) {
      if (radii[i] >= smallest && std::isfinite(radii[i])) continue;
      const std::string which = radii.size() == 1 ? "the radius" : fmt::format("radius {} of {}", i + 1, radii.size());
      return add(fmt::format("{} is {}", which, radii[i]), radii[i] > 0
                                                               ? "a radius is at least 1e-15; scale the scene up"
                                                               : "a radius is a finite number above 0");
    }
  }

 private:
  const SourceLocation& where_;
  Diagnostics& all_;
};

void check(const PointSkeleton& point, Findings& findings) {
  findings.check_positions({&point.at, 1});
  findings.check_radii({&point.radius, 1});
}

void check(const SegmentSkeleton& segment, Findings& findings) {
  const Vec3d ends[] = {segment.from, segment.to};
  const double radii[] = {segment.radius_from, segment.radius_to};
  findings.check_positions(ends);
  if (radii[0] == radii[1]) findings.check_radii({radii, 1});
  else findings.check_radii(radii);
}

// What has a list of points and one of radii.
void check_line(const auto& line, const std::string& kind, Findings& findings) {
  if (line.points.size() < 2)
    findings.add(fmt::format("a {} of {} points", kind, line.points.size()),
                 fmt::format("a {} has at least 2 points", kind));
  if (line.points.size() != line.radii.size())
    findings.add(fmt::format("{} points but {} radii", line.points.size(), line.radii.size()),
                 "give one radius for each point");
  findings.check_positions(line.points);
  findings.check_radii(line.radii);
}

void check(const PolylineSkeleton& polyline, Findings& findings) { check_line(polyline, "polyline", findings); }

// Three vertices in one line leave no more than rounding of the area of a square.
void check(const TriangleSkeleton& triangle, Findings& findings) {
  const auto& [a, b, c] = triangle.vertices;
  findings.check_positions(triangle.vertices);
  findings.check_radii(triangle.radii);
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  if (!(length(cross(b - a, c - a)) > 1e-12 * longest * longest))
    findings.add("a triangle without area", "its vertices must not lie on one line");
}

void check(const ArcSkeleton& arc, Findings& findings) {
  const double radii[] = {arc.major, arc.radius_from, arc.radius_to};
  findings.check_positions({&arc.center, 1});
  findings.check_radii(radii);
  const double skew = std::max({std::fabs(length_squared(arc.axis1) - 1), std::fabs(length_squared(arc.axis2) - 1),
                                std::fabs(dot(arc.axis1, arc.axis2))});
  if (!(skew < 1e-9)) findings.add("the axes of an arc are not orthonormal", "give two unit vectors at right angles");
  if (!(arc.end > arc.begin && arc.end - arc.begin < 2 * std::numbers::pi * (1 + 1e-12)))
    findings.add(fmt::format("an arc from {} to {} radians", arc.begin, arc.end),
                 "an arc has a positive angle of at most one turn");
}

void check(const CurveSkeleton& curve, Findings& findings) {
  check_line(curve, "curve", findings);
  if (curve.levels < 0 || curve.levels > CurveSkeleton::max_levels)
    return findings.add(fmt::format("{} levels of subdivision", curve.levels),
                        fmt::format("levels are a whole number from 0 to {}", CurveSkeleton::max_levels));
  if (curve.points.size() > max_curve_points >> curve.levels)
    findings.add(fmt::format("a curve of {} points, doubled {} times", curve.points.size(), curve.levels),
                 "use fewer levels");
  for (const int i : curve.sticking)
    if (i < 0 || static_cast<std::size_t>(i) >= curve.points.size())
      return findings.add(fmt::format("the sticking joint {} of a curve of {} points", i, curve.points.size()),
                          "joints are counted from 0");
}

void check(const SharedSkeletonGraph& graph, Findings& findings) {
  if (!graph) return findings.add("a skeleton without data", "the skeleton file was not read");
  const std::size_t count = graph->positions.size();
  if (graph->radii.size() != count || graph->parents.size() != count)
    return findings.add(fmt::format("a skeleton with {} positions, {} radii and {} parents", count, graph->radii.size(),
                                    graph->parents.size()),
                        "every node has a position, a radius and a parent");
  if (count == 0) findings.add("a skeleton without nodes", "the file holds at least one node");
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t parent = graph->parents[i];
    if (parent == SkeletonGraph::no_parent) continue;
    if (parent >= 0 && parent < static_cast<std::int64_t>(count) && parent != static_cast<std::int64_t>(i)) continue;
    findings.add(fmt::format("node {} of the skeleton has the parent {}", i, parent),
                 fmt::format("a parent is another of the nodes 0 to {}, or none", count - 1));
    break;
  }
  findings.check_positions(graph->positions);
  findings.check_radii(graph->radii);
}

void check_alpha(double alpha, Findings& findings) {
  if (!(alpha >= smallest_alpha && alpha <= largest_alpha))
    findings.add(fmt::format("alpha {} is out of range", alpha),
                 "alpha is from -1 to pi/2 radians, or contact, or sum, or per_skeleton");
}

void check_attributes(const std::vector<Attribute>& attributes, std::size_t nodes, Findings& findings) {
  for (const Attribute& attribute : attributes) {
    if (attribute.values.size() != 1 && attribute.values.size() != nodes)
      findings.add(fmt::format("{} values of the attribute `{}`", attribute.values.size(), attribute.name),
                   fmt::format("give one value for all, or one for each of the {} nodes", nodes));
    for (const double value : attribute.values)
      if (!std::isfinite(value))
        return findings.add("an attribute that is not finite", "attributes are finite numbers");
  }
}

void check(const Primitive& primitive, Findings& findings) {
  std::visit([&](const auto& skeleton) { check(skeleton, findings); }, primitive.skeleton);
  if (primitive.alpha) check_alpha(*primitive.alpha, findings);
  if (primitive.alpha_bounds)
    for (const double alpha : *primitive.alpha_bounds) check_alpha(alpha, findings);
  if (primitive.attributes.empty()) return;
  const auto* graph = std::get_if<SharedSkeletonGraph>(&primitive.skeleton);
  if (graph == nullptr || *graph) check_attributes(primitive.attributes, node_count(primitive), findings);
}

void check_shape(const Kernel& kernel, Findings& findings) {
  const double least = kernel.family == KernelFamily::Compact ? 1 : 0;
  if (kernel.family != KernelFamily::Inverse && !(kernel.shape > least && std::isfinite(kernel.shape)))
    findings.add(fmt::format("a kernel of {} {}", least == 0 ? "scale" : "support", kernel.shape),
                 "the scale of a Cauchy kernel is above 0, the support of a compact one above 1 radius");
}

// Below 0 an angle is defined for the inverse kernel and the paper's projection.
void check_angle_of(const Blend& blend, double alpha, Findings& findings) {
  check_alpha(alpha, findings);
  if (!(alpha >= smallest_alpha && alpha < 0)) return;
  if (blend.kernel.family != KernelFamily::Inverse)
    findings.add(fmt::format("alpha {} with this kernel", alpha), "below alpha = 0 only `inverse` is defined");
  else if (blend.projection == Projection::Exact)
    findings.add(fmt::format("alpha {} with the exact projection", alpha),
                 "below alpha = 0 only `projection: paper` is defined");
}

void check_ramp(const Blend& blend, const AlphaRamp& ramp, Findings& findings) {
  for (const double alpha : ramp.to) check_angle_of(blend, alpha, findings);
  if (!(ramp.from[0] < ramp.from[1]) || !std::isfinite(ramp.from[1] - ramp.from[0]))
    findings.add(fmt::format("a ramp from {} to {}", ramp.from[0], ramp.from[1]), "two values, the smaller first");
}

void check_rule(const Blend& blend, Findings& findings) {
  std::visit(Overloaded{[&](double alpha) { check_angle_of(blend, alpha, findings); },
                        [&](const AlphaDirection& rule) {
                          check_angle_of(blend, rule.least, findings);
                          check_angle_of(blend, rule.most, findings);
                        },
                        [&](const AlphaAttribute& rule) {
                          if (rule.ramp) check_ramp(blend, *rule.ramp, findings);
                        },
                        [&](const AlphaFromField& rule) { check_ramp(blend, rule.ramp, findings); },
                        [&](const AlphaLocalContact& rule) {
                          if (rule.density && (blend.kernel.family != KernelFamily::Inverse ||
                                               blend.kernel.degree > LocalContact::max_dense_degree))
                            findings.add("a contact that adapts to density with this kernel",
                                         fmt::format("it needs the kernel `inverse` of a degree up to {}",
                                                     LocalContact::max_dense_degree));
                        },
                        [](const auto&) {}},
             blend.alpha);
}

void check(const Blend& blend, Findings& findings) {
  const int degree = blend.kernel.degree;
  if (degree < min_kernel_degree || degree > max_kernel_degree)
    findings.add(fmt::format("kernel degree {} is out of range", degree),
                 fmt::format("the degree is a whole number from {} to {}", min_kernel_degree, max_kernel_degree));
  check_shape(blend.kernel, findings);
  check_rule(blend, findings);
  if (blend.of.empty()) findings.add("a blend of nothing", "list primitives under `of:`");
}

void check(const Union& united, Findings& findings) {
  if (united.of.empty()) findings.add("a union of nothing", "list fields under `of:`");
}

void check(const GeneralNode& node, Findings& findings) {
  if (!node.node) return findings.add("a general node without parameters", "every node has its parameters");
  for (auto& [message, hint] : problems_of(node.node->node, node.of.size())) findings.add(message, hint);
}

void check(const Transform& transform, Findings& findings) {
  const auto& [x, y, z] = transform.parent_from_child.columns;
  if (!is_finite(x) || !is_finite(y) || !is_finite(z) || !is_finite(transform.parent_from_child.translation))
    return findings.add("a transform that is not finite", "translations, angles and scales are finite numbers");
  // |det| against the volume its column lengths would span: 0 for a flat map of any size.
  const double volume = length(x) * length(y) * length(z);
  if (!(std::fabs(transform.parent_from_child.determinant()) > 1e-12 * volume))
    findings.add("a singular transform: it flattens what it places", "no scale may be 0");
}

void check_children(std::span<const FieldNodeId> children, std::size_t parent, Findings& findings) {
  for (const FieldNodeId child : children)
    if (!child.valid() || child.index() >= parent)
      return findings.add("a child does not stand before its parent", "children stand before their parents");
}

}  // namespace

Diagnostics validate(const FieldDescription& description) {
  Diagnostics all;
  for (std::size_t i = 0; i < description.nodes.size(); ++i) {
    const FieldNode& node = description.nodes[i];
    Findings findings(node.where, all);
    std::visit(Overloaded{[&](const Primitive& p) { check(p, findings); },
                          [&](const Transform& t) {
                            check(t, findings);
                            check_children({&t.of, 1}, i, findings);
                          },
                          [&](const auto& group) {
                            check(group, findings);
                            check_children(group.of, i, findings);
                          }},
               node.what);
    if (const Blend* blend = std::get_if<Blend>(&node.what))
      if (const auto* rule = std::get_if<AlphaFromField>(&blend->alpha)) check_children({&rule->field, 1}, i, findings);
  }
  if (!description.root.valid() || description.root.index() >= description.nodes.size())
    all.push_back(failure("a field without a root"));
  return all;
}

}  // namespace marrow
