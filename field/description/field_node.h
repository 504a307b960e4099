// A field as its author wrote it: a tree of nodes in one array. Plain data, comparable, no evaluation.
#pragma once

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
/// or the kernel of the smallest scaled distance (eq. 4 of Zanni et al. 2015, corrected to a maximum).
enum class SkeletonModel { Integral, Distance };

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
struct PolylineSkeleton {
  std::vector<Vec3d> points;
  std::vector<double> radii;  ///< one for each point
  friend bool operator==(const PolylineSkeleton&, const PolylineSkeleton&) = default;
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

/// What a blend sums. A root without children contributes a point.
struct Primitive {
  std::variant<PointSkeleton, SegmentSkeleton, PolylineSkeleton, SharedSkeletonGraph> skeleton;
  std::optional<SkeletonModel> model;  ///< default: the blend's
  std::optional<double> alpha;         ///< used by alpha: per_skeleton
  MaterialId material;                 ///< invalid: the object's
};

/// Degree n >= 3 of the kernel family; the degree of a point is n-1, of a curve n (field-maths sec. 1).
struct InverseKernel {
  int degree = 4;
  friend bool operator==(const InverseKernel&, const InverseKernel&) = default;
};

/// Projection angle of the correction operator (Zanni et al. 2015, sec. 4).
struct AlphaContact {};  ///< the value at which two equal skeletons blend exactly when they touch
struct AlphaSum {};      ///< pi/2: the plain sum
using Alpha = std::variant<AlphaContact, AlphaSum, double>;  ///< or radians, in [-1, pi/2]

enum class Projection { Paper, Exact };

/// n-ary blend with topology control (Zanni, Cani, Gleicher 2015); iso-value 1.
/// Children: primitives, or transforms (similarities) of primitives.
struct Blend {
  InverseKernel kernel;
  Alpha alpha = AlphaContact{};
  bool cavity = true;
  Projection projection = Projection::Paper;
  SkeletonModel model = SkeletonModel::Integral;
  std::vector<FieldNodeId> of;
};
/// Crisp union: the largest child value. Children need not be blends.
struct Union {
  std::vector<FieldNodeId> of;
};
struct Transform {
  Affine parent_from_child;
  FieldNodeId of;
};

struct FieldNode {
  std::variant<Primitive, Blend, Union, Transform> what;
  SourceLocation where;
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
