// Turns what lies away from a box into weighted points; internal to blend/.
#pragma once

#include "field/blend/blend_field.h"
#include "field/blend/local/source_rule.h"
#include "field/blend/sources/source_sums.h"
#include "field/math/box3.h"

namespace marrow {

/// For one box: primitives, or parts of them, go to sources where rules are certified, and to a rest where not.
class SourceMaker {
 public:
  /// Each primitive adds at most `error` times its field, where that is between `share` and 1. `marked`: what is made
  /// has a radius_mark() of the blend.
  SourceMaker(const BlendField&, const Box3&, bool marked, double error, double share);

  /// All of a list.
  void add(const PrimitiveList<PointSkeleton>&);
  void add(const PrimitiveList<SegmentSkeleton>&);
  void add(const PrimitiveList<ArcSkeleton>&);
  void add(const PrimitiveList<TriangleSkeleton>&);

  SourceLists sources;
  double f_error = 0, S_error = 0;
  PrimitiveList<PointSkeleton> rest_points;
  PrimitiveList<SegmentSkeleton> rest_segments;
  PrimitiveList<ArcSkeleton> rest_arcs;
  PrimitiveList<TriangleSkeleton> rest_triangles;

 private:
  /// A skeleton from the box: a lower bound of its distance, with its lift, and whether that is too little.
  struct View {
    double lifted;
    bool too_near;
  };
  View seen(double distance, double least_radius) const;
  double allowed(double mass, double radius, double distance, int m) const;
  void note(double mass, double radius, double distance, int m, double relative);
  void emit(SourceSums&, const Vec3d& at, double weight, double radius, int dimension) const;
  template <class Skeleton, class Add>
  void add_all(const PrimitiveList<Skeleton>&, const Add&);
  template <class Skeleton>
  void leave(const Skeleton&, PrimitiveList<Skeleton>& rest) const;
  void add(const PointSkeleton&);
  template <class Skeleton>
  void divide(const Skeleton&, PrimitiveList<Skeleton>& rest);
  template <class Curve, class Place>
  bool add_curve(const Curve&, double half_angle, double distance, const Place&);
  bool add_part(const SegmentSkeleton&, double distance);
  bool add_part(const ArcSkeleton&, double distance);
  bool add_part(const TriangleSkeleton&, double distance);

  int degree_;
  double per_lift_ = 0;  ///< lift over radius: 1 / scale of the Cauchy kernel; 0 for the inverse one
  double unit_[3];       ///< weight of a unit of measure, by dimension
  Vec3d center_;
  double rho_, error_, share_;
  bool marked_;
  double reference_;  ///< radius
  double mark_ = 0;   ///< of the skeleton that is added
};

}  // namespace marrow
