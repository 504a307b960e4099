// A field as its author wrote it: a tree of nodes in one array. Plain data, comparable, no evaluation.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "field/base/diagnostics.h"
#include "field/base/id.h"
#include "field/math/affine.h"
#include "field/math/vec3.h"

namespace marrow {

using FieldNodeId = Id<struct FieldNodeTag>;

/// Whether a primitive is the integral of the kernel along its skeleton (SCALIS, Zanni et al. 2013)
/// or the kernel of the smallest scaled distance (eq. 4 of Zanni et al. 2015, corrected to a maximum), or the older
/// integral of 1/r^3 with the radius at the foot of the point (Cani and Hornus 2001; points and lines, inverse kernel
/// of degree 3).
enum class SkeletonModel { Integral, Distance, CaniHornus };

/// Radii are surface radii: an isolated infinite line of radius r has its surface at distance r.
struct PointSkeleton {
  Vec3d at;
  double radius = 1;
  friend bool operator==(const PointSkeleton&, const PointSkeleton&) = default;
};
/// Radius linear from `radius_from` to `radius_to`.
struct SegmentSkeleton {
  Vec3d from, to;
  double radius_from = 1, radius_to = 1;
  friend bool operator==(const SegmentSkeleton&, const SegmentSkeleton&) = default;
};
/// Radius linear over the triangle.
struct TriangleSkeleton {
  std::array<Vec3d, 3> vertices;
  std::array<double, 3> radii{1, 1, 1};
  friend bool operator==(const TriangleSkeleton&, const TriangleSkeleton&) = default;
};
/// center + major (cos angle axis1 + sin angle axis2), begin <= angle <= end in radians, at most one turn; a whole turn
/// is a circle. The axes are orthonormal. Radius linear in the angle.
struct ArcSkeleton {
  Vec3d center, axis1{1, 0, 0}, axis2{0, 1, 0};
  double major = 1;
  double begin = 0, end = 6.283185307179586;
  double radius_from = 1, radius_to = 1;
  friend bool operator==(const ArcSkeleton&, const ArcSkeleton&) = default;
};
struct PolylineSkeleton {
  std::vector<Vec3d> points;
  std::vector<double> radii;  ///< one for each point
  friend bool operator==(const PolylineSkeleton&, const PolylineSkeleton&) = default;
};
enum class Subdivision { Chaikin, Cubic };
/// A control polyline that is refined `levels` times (field/skeleton/subdivision_curve.h).
struct CurveSkeleton {
  /// Each level doubles the points: 12 levels place them closer than any picture shows.
  static constexpr int max_levels = 12;
  std::vector<Vec3d> points;
  std::vector<double> radii;  ///< one for each point
  Subdivision subdivision = Subdivision::Chaikin;
  int levels = 4;             ///< level of detail; 0 is the control polyline itself
  std::vector<int> sticking;  ///< indices of points through which the curve passes as it is; both ends always do
  bool closed = false;        ///< the last point is joined to the first
  friend bool operator==(const CurveSkeleton&, const CurveSkeleton&) = default;
};
/// A forest of nodes, each joined to its parent by a segment. Built by the SWC reader.
struct SkeletonGraph {
  static constexpr std::int32_t no_parent = -1;
  std::vector<Vec3d> positions;
  std::vector<double> radii;
  std::vector<std::int32_t> parents;  ///< index into the arrays, or no_parent
  friend bool operator==(const SkeletonGraph&, const SkeletonGraph&) = default;
};
/// Shared: a large skeleton placed many times is held once. Never null in a valid description.
using SharedSkeletonGraph = std::shared_ptr<const SkeletonGraph>;

/// A number that an author gives to a skeleton, linear between its nodes.
struct Attribute {
  std::string name;
  std::vector<double> values;  ///< one for all nodes, or one for each
  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// What a blend sums. A root without children contributes a point.
struct Primitive {
  std::variant<PointSkeleton, SegmentSkeleton, PolylineSkeleton, CurveSkeleton, SharedSkeletonGraph, TriangleSkeleton,
               ArcSkeleton>
      skeleton;
  std::optional<SkeletonModel> model;                 ///< default: the blend's
  std::optional<double> alpha;                        ///< radians in [-1, pi/2], used by AlphaPerSkeleton
  std::optional<std::array<double, 2>> alpha_bounds;  ///< of crossing and of parallel, used by AlphaDirection
  std::vector<Attribute> attributes;                  ///< used by AlphaAttribute
  MaterialId material;                                ///< invalid: the object's
};

enum class KernelFamily { Inverse, Cauchy, Compact };
/// Degree n >= 3 of the kernel family; the degree of a point is n-1, of a curve n (so both fall alike; the other way
/// round for the compact kernel).
struct Kernel {
  KernelFamily family = KernelFamily::Inverse;
  int degree = 4;
  double shape = 1;  ///< Cauchy: the scale s > 0; compact: the support R > 1, in radii; inverse: not used
  friend bool operator==(const Kernel&, const Kernel&) = default;
};

/// Projection angle of the correction operator (Zanni et al. 2015, sec. 4).
struct AlphaContact {};  ///< the value at which two equal skeletons blend exactly when they touch
struct AlphaSum {};      ///< pi/2: the plain sum
/// Mean of the primitives' own angles, weighted by their fields (eq. 14); contact for those without.
struct AlphaPerSkeleton {};
/// From a value to an angle: linear from `from` to `to`, level outside.
struct AlphaRamp {
  std::array<double, 2> from{0, 1}, to{0, 1};
  double operator()(double value) const {
    const double share = (value - from[0]) / (from[1] - from[0]);
    return to[0] + (to[1] - to[0]) * (share < 0 ? 0 : share > 1 ? 1 : share);
  }
  friend bool operator==(const AlphaRamp&, const AlphaRamp&) = default;
};
/// Directional blending (eq. 15, 16): the angle of crossing strands and of parallel ones. A polyline, curve or skeleton
/// is one strand.
struct AlphaDirection {
  double least = 0, most = 0;
};
/// As AlphaPerSkeleton, with the angle from an attribute of the skeleton; `radius` is always there. Without a ramp the
/// attribute is the angle.
struct AlphaAttribute {
  std::string name;
  std::optional<AlphaRamp> ramp;
};
/// The angle from the value of another field.
struct AlphaFromField {
  FieldNodeId field;
  AlphaRamp ramp;
};
/// Contact, adapted to unequal radii and to how many skeletons meet (field/blend/angle/local_contact.h).
struct AlphaLocalContact {
  bool radii = true, density = true;
};
/// Or radians, in [-1, pi/2].
using Alpha = std::variant<AlphaContact, AlphaSum, double, AlphaPerSkeleton, AlphaDirection, AlphaAttribute,
                           AlphaFromField, AlphaLocalContact>;

enum class Projection { Paper, Exact };

/// n-ary blend with topology control (Zanni, Cani, Gleicher 2015); iso-value 1.
/// Children: primitives, groups, or transforms (similarities) of them.
struct Blend {
  Kernel kernel;
  Alpha alpha = AlphaContact{};
  bool cavity = true;
  Projection projection = Projection::Paper;
  SkeletonModel model = SkeletonModel::Integral;
  std::vector<FieldNodeId> of;
};
/// What a primitive by itself stands for: a blend of one, with the defaults.
inline Blend blend_of_one(FieldNodeId primitive) {
  Blend blend;
  blend.of = {primitive};
  return blend;
}
/// Crisp union: the largest child value. Children need not be blends.
struct Union {
  std::vector<FieldNodeId> of;
  bool is_group = false;  ///< a union but in a blend, which takes its children as its own
};
struct Transform {
  Affine parent_from_child;
  FieldNodeId of;
};

/// A node of field/tree/any_node.h, where it is defined: what reads or draws descriptions does not depend on its kinds.
struct BoxedNode;

/// Any of the general nodes. Children need not be general nodes.
struct GeneralNode {
  std::shared_ptr<const BoxedNode> node;  ///< never null in a valid description
  std::vector<FieldNodeId> of;
  MaterialId material;  ///< of a node without children; invalid: the object's
};

struct FieldNode {
  std::variant<Primitive, Blend, Union, Transform, GeneralNode> what;
  SourceLocation where;
  /// Not 0: nodes with this number are the same subtree, which fields of several objects hold. What is made of it in
  /// its own coordinates can serve them all.
  std::size_t shared = 0;
};

/// Children always stand before their parents in `nodes`, so that no step needs recursion.
struct FieldDescription {
  std::vector<FieldNode> nodes;
  FieldNodeId root;

  const FieldNode& operator[](FieldNodeId id) const { return nodes[id.index()]; }
  FieldNodeId add(FieldNode node) {
    nodes.push_back(std::move(node));
    return FieldNodeId{nodes.size() - 1};
  }
};

}  // namespace marrow
