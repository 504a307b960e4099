// One blend in flat form, in its own coordinates: lists of primitives and the correction of their sum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "field/base/id.h"
#include "field/blend/angle/alpha_sample.h"
#include "field/blend/angle/directional_alpha.h"
#include "field/blend/correction/correction.h"
#include "field/blend/material_weights.h"
#include "field/description/field_node.h"
#include "field/math/box3.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

class LocalContact;

/// Primitives of one kind and the material and angle of each. Invariant: materials is empty (all are the object's) or
/// parallel to skeletons; alphas is parallel to skeletons in a blend with `alpha_per_skeleton`, else empty; alphas_to
/// is empty or parallel to skeletons, and then an angle is linear from the one at the begin to this one at the end; of
/// a triangle alphas_to is that of the second corner and alphas_third (else empty) that of the third; strands is empty
/// (each by itself) or parallel to skeletons, ascending: what has one number came from one polyline, curve, ...;
/// log_radii is empty, or, where these are parts of the skeletons of another blend, holds their radius_mark() there.
template <class Skeleton>
struct PrimitiveList {
  std::vector<Skeleton> skeletons;
  std::vector<MaterialId> materials;
  std::vector<double> alphas, alphas_to, alphas_third, log_radii;
  std::vector<std::uint32_t> strands;

  std::size_t size() const { return skeletons.size(); }
  bool empty() const { return skeletons.empty(); }
  /// Whether the angle of a skeleton is not the same all over it.
  bool angle_varies(std::size_t i) const {
    return (!alphas_to.empty() && alphas_to[i] != alphas[i]) || (!alphas_third.empty() && alphas_third[i] != alphas[i]);
  }
  MaterialId material(std::size_t i) const { return materials.empty() ? MaterialId{} : materials[i]; }
  void add(const Skeleton& skeleton, MaterialId material_id) {
    if (material_id.valid() && materials.empty()) materials.resize(skeletons.size());
    if (material_id.valid() || !materials.empty()) materials.push_back(material_id);
    skeletons.push_back(skeleton);
  }
};

/// Polylines and skeleton graphs are flattened to segments, an isolated root of a graph to a point.
/// A point has the same field in both skeleton models. Every radius is > 0 and every segment has length > 0.
/// Distance segments of one strand are one primitive: the largest of them counts.
/// Under another kernel than the inverse one alpha is not negative. Segments of Cani and Hornus stand only under the
/// inverse kernel of degree 3.
struct BlendField {
  int degree = 4;
  KernelFamily kernel = KernelFamily::Inverse;
  double kernel_shape = 1;            ///< Kernel::shape
  double alpha = 1.5707963267948966;  ///< resolved, radians in [-1, pi/2]; pi/2 is the plain sum
  bool alpha_per_skeleton = false;    ///< then each primitive has its own, and `alpha` holds where all fields are 0
  /// By strand, with a bound for each number of a strand; empty otherwise. Points and triangles have no direction.
  std::vector<DirectionBounds> direction_bounds;
  std::shared_ptr<const LocalContact> local_contact;  ///< null: not used
  std::shared_ptr<const AlphaSource> alpha_source;    ///< null: not used
  bool cavity = true;
  Projection projection = Projection::Paper;
  PrimitiveList<PointSkeleton> points;
  PrimitiveList<SegmentSkeleton> segments;           ///< integral (SCALIS) model
  PrimitiveList<SegmentSkeleton> distance_segments;  ///< distance model
  PrimitiveList<SegmentSkeleton> cani_hornus_segments;
  PrimitiveList<TriangleSkeleton> triangles, distance_triangles;
  PrimitiveList<ArcSkeleton> arcs, distance_arcs;  ///< and circles

  /// At most one of the rules is there.
  bool alpha_varies() const {
    return alpha_per_skeleton || !direction_bounds.empty() || local_contact != nullptr || alpha_source != nullptr;
  }
  template <class Visit>
  void for_each_list(const Visit& visit) const {
    visit(points);
    visit(segments);
    visit(distance_segments);
    visit(cani_hornus_segments);
    visit(triangles);
    visit(distance_triangles);
    visit(arcs);
    visit(distance_arcs);
  }
  std::size_t size() const {
    std::size_t count = 0;
    for_each_list([&](const auto& list) { count += list.size(); });
    return count;
  }
};

inline Kernel kernel_of(const BlendField& blend) { return {blend.kernel, blend.degree, blend.kernel_shape}; }

/// The blend's operator at one angle, radians.
inline Correction correction_at(const BlendField& blend, double alpha) {
  return Correction(kernel_of(blend), alpha, blend.cavity, blend.projection);
}

/// Inside where corrected > 1. On a skeleton the values are infinite and the gradients 0.
struct BlendSample {
  double sum = 0;              ///< f = sum f_i
  Vec3d sum_gradient{};        ///< grad f
  Vec3d si_gradient{};         ///< sum of grad_S f_i
  double si_norm = 0;          ///< G = |si_gradient|
  double alpha = 0;            ///< radians, as used at p
  double corrected = 0;        ///< C(f, G)
  Vec3d corrected_gradient{};  ///< in closed form
};
BlendSample evaluate(const BlendField&, const Vec3d& p);

/// The `corrected` of evaluate(), bit for bit, without the derivatives that only its gradient needs.
double corrected_value(const BlendField&, const Vec3d& p);

/// The plain sums, as far as asked for.
template <Derivatives>
SkeletonSample sum_of_primitives(const BlendField&, const Vec3d& p);

/// With its constant alpha, which is not used when alpha varies.
Correction correction_of(const BlendField&);

/// The angle used at p: constant, or
///   per skeleton  sum f_i alpha_i / sum f_i   [Zanni et al. 2015, eq. 14], linear angles weighted along the skeleton,
///                 or under the distance model taken where it is nearest,
///   by strand     directional_alpha.h,
///   local contact local_contact.h,   or from a source.
/// Where the sum is 0 or infinite: the alpha of the blend, without gradient.
AlphaSample alpha_at(const BlendField&, const Vec3d& p);

/// The angle of a blend whose rule gives the same one everywhere (but where the sum is 0 or infinite): constant, or of
/// skeletons that all have the same one, or by the directions of two or more points, which have none and so all cross,
/// or at contact adapted to radii that are all the same.
std::optional<double> single_angle(const BlendField&);

/// What of a blend the tracer of blends has no bounds for, as a message; empty when it can trace all of it. The tracer
/// of general trees takes any blend.
std::string untraceable_part(const BlendField&);

/// w_i = f_i / sum f_j, summed over the primitives of each material, so that it does not matter how a skeleton is cut.
/// On a skeleton its own alone.   [physics 2.3]
MaterialWeights material_weights(const BlendField&, const Vec3d& p);
/// The material with the largest weight at p; invalid means the object's own.
MaterialId strongest_material(const BlendField&, const Vec3d& p);

/// Bounds of the skeletons themselves, without radii. Empty for a blend without primitives.
Box3 skeleton_bounds(const BlendField&);
/// Largest radius of any primitive; 0 for a blend without primitives.
double largest_radius(const BlendField&);

}  // namespace marrow
