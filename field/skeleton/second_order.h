// Fields of single primitives with all second derivatives: what the Hessian of a corrected field is made of.
#pragma once

#include <array>

#include "field/description/field_node.h"
#include "field/number/functions.h"
#include "field/number/variables_at.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// f and grad_S f (as of SkeletonSample), each with gradient and Hessian by p. Sums are plain.
/// On the skeleton itself the field is +infinity and every derivative 0.
struct SecondOrderSample {
  HessianJet field;
  Vec3<HessianJet> si;

  static SecondOrderSample on_skeleton() { return {.field = std::numeric_limits<double>::infinity(), .si = {}}; }
  SecondOrderSample& operator+=(const SecondOrderSample& b) {
    field += b.field;
    si += b.si;
    return *this;
  }
};

/// Integrals: the same quadratures as for the fields themselves, with the second derivatives of the kernel under the
/// integral; relative error below 1e-12. Under the compact kernel, whose edge moves with p, the nodes of a segment move
/// with it; arcs and triangles there, and only there, take differences of first derivatives (1e-6).
SecondOrderSample second_order(const PointSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderSample second_order(const SegmentSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderSample second_order(const TriangleSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderSample second_order(const ArcSkeleton&, const Vec3d& p, const Kernel&);

/// The kernel of the smallest scaled distance; the place that is nearest moves with p.   [Zanni et al. 2015, eq. 4]
SecondOrderSample second_order_by_distance(const SegmentSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderSample second_order_by_distance(const TriangleSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderSample second_order_by_distance(const ArcSkeleton&, const Vec3d& p, const Kernel&);

/// Cani and Hornus 2001, as of cani_hornus_field().
SecondOrderSample second_order_of_cani_hornus(const SegmentSkeleton&, const Vec3d& p);

/// What shares.h tells, with Hessians. The nearest ones are places alone, not weighted by the field.
using SecondOrderShares = std::array<HessianJet, 2>;
SecondOrderShares second_order_shares(const PointSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderShares second_order_shares(const SegmentSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderShares second_order_shares(const TriangleSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderShares second_order_shares(const ArcSkeleton&, const Vec3d& p, const Kernel&);
SecondOrderShares second_order_nearest_shares(const SegmentSkeleton&, const Vec3d& p);
SecondOrderShares second_order_nearest_shares(const TriangleSkeleton&, const Vec3d& p);
SecondOrderShares second_order_nearest_shares(const ArcSkeleton&, const Vec3d& p);
SecondOrderShares second_order_foot_shares(const SegmentSkeleton&, const Vec3d& p);
Vec3<HessianJet> second_order_direction(const ArcSkeleton&, const Vec3d& p, const Kernel&);
Vec3<HessianJet> second_order_nearest_direction(const ArcSkeleton&, const Vec3d& p);

}  // namespace marrow
