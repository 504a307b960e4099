// From the skeleton that an author wrote to the flat lists of a blend; internal to program/.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "field/blend/blend_field.h"
#include "field/description/field_node.h"
#include "field/math/affine.h"
#include "field/program/node_angles.h"
#include "field/skeleton/subdivision_curve.h"

namespace marrow {

/// Adds the skeleton of one primitive to a blend, mapped by a similarity.
class Flattener {
 public:
  Flattener(BlendField& field, const Affine& map, double scale, SkeletonModel model, const Primitive& primitive,
            const Alpha& alpha, std::uint32_t strand)
      : field_(field),
        map_(map),
        scale_(scale),
        model_(primitive.model.value_or(model)),
        material_(primitive.material),
        angles_(primitive, alpha, field.alpha),
        strand_(strand) {}

  void operator()(const PointSkeleton& s) { add_point(s, 0); }

  // A segment of no length has no integral; its scaled distance is that of its larger end.
  void operator()(const SegmentSkeleton& s) {
    if (model_ == SkeletonModel::Distance && !(length(s.to - s.from) > 0))
      add_point({s.from, std::max(s.radius_from, s.radius_to)}, 0);
    else add_segment(s.from, s.to, s.radius_from, s.radius_to, 0, 1);
  }

  void operator()(const PolylineSkeleton& s) {
    segments().skeletons.reserve(segments().size() + s.points.size());
    for (std::size_t i = 1; i < s.points.size(); ++i)
      add_segment(s.points[i - 1], s.points[i], s.radii[i - 1], s.radii[i], i - 1, i);
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
        add_segment(s.positions[parent], s.positions[i], s.radii[parent], s.radii[i], parent, i);
      } else if (!has_child[i]) {
        add_point({s.positions[i], s.radii[i]}, i);
      }
    }
  }

  void operator()(const TriangleSkeleton& s) {
    TriangleSkeleton mapped = s;
    for (Vec3d& vertex : mapped.vertices) vertex = map_.point(vertex);
    for (double& radius : mapped.radii) radius *= scale_;
    auto& list = model_ == SkeletonModel::Distance ? field_.distance_triangles : field_.triangles;
    add(list, mapped, angles_.of(0));
    add_angle(list.alphas_to, 1);
    add_angle(list.alphas_third, 2);
  }

  void operator()(const ArcSkeleton& s) {
    ArcSkeleton mapped = s;
    mapped.center = map_.point(s.center);
    mapped.axis1 = map_.vector(s.axis1) / scale_;
    mapped.axis2 = map_.vector(s.axis2) / scale_;
    mapped.major *= scale_;
    mapped.radius_from *= scale_;
    mapped.radius_to *= scale_;
    auto& list = model_ == SkeletonModel::Distance ? field_.distance_arcs : field_.arcs;
    add(list, mapped, angles_.of(0));
    add_angle(list.alphas_to, 1);
  }

  SkeletonModel model() const { return model_; }
  std::size_t without_length() const { return without_length_; }

 private:
  template <class Skeleton>
  void add(PrimitiveList<Skeleton>& list, const Skeleton& mapped, double alpha) {
    list.add(mapped, material_);
    if (field_.alpha_per_skeleton) list.alphas.push_back(alpha);
    if (!field_.direction_bounds.empty()) list.strands.push_back(strand_);
  }
  void add_angle(std::vector<double>& angles, std::size_t node) {
    if (field_.alpha_per_skeleton) angles.push_back(angles_.of(node));
  }
  void add_point(const PointSkeleton& s, std::size_t node) {
    add(field_.points, PointSkeleton{map_.point(s.at), s.radius * scale_}, angles_.of(node));
  }
  PrimitiveList<SegmentSkeleton>& segments() {
    if (model_ == SkeletonModel::Integral) return field_.segments;
    return model_ == SkeletonModel::Distance ? field_.distance_segments : field_.cani_hornus_segments;
  }
  void add_segment(const Vec3d& from, const Vec3d& to, double radius_from, double radius_to, std::size_t first,
                   std::size_t second) {
    const SegmentSkeleton mapped{map_.point(from), map_.point(to), radius_from * scale_, radius_to * scale_};
    if (!(length(mapped.to - mapped.from) > 0)) return void(++without_length_);
    add(segments(), mapped, angles_.of(first));
    add_angle(segments().alphas_to, second);
    if (model_ == SkeletonModel::Distance && field_.direction_bounds.empty()) segments().strands.push_back(strand_);
  }

  BlendField& field_;
  const Affine& map_;
  double scale_;
  SkeletonModel model_;
  MaterialId material_;
  NodeAngles angles_;
  std::uint32_t strand_;
  std::size_t without_length_ = 0;
};

}  // namespace marrow
