// Second derivatives of primitives under compact kernels of which those of the kernel itself have no bound; internal to
// blend/.
#pragma once

#include "field/description/field_node.h"
#include "field/kernel/profile.h"
#include "field/math/box3.h"

namespace marrow {

/// Places and radii in the same units; precondition: m < 4.
/// |D^2 f|, its longest image of a unit vector, at most at any place within rho of p under k_m = w^(m/2), w = 1 - (d /
/// (R radius))^2, of degree m = 3, or of triangles 2: its second derivatives grow without bound towards the edge of the
/// support, or its first ones jump there, but integrals of them need not. Infinite where they do: at a place at whose
/// edge half a circle lies at once, say.
double edge_bend(const PointSkeleton&, const Profile&, double R, const Vec3d& p, double rho);
double edge_bend(const SegmentSkeleton&, const Profile&, double R, const Vec3d& p, double rho);
double edge_bend(const ArcSkeleton&, const Profile&, double R, const Vec3d& p, double rho);
double edge_bend(const TriangleSkeleton&, const Profile&, double R, const Vec3d& p, double rho);

/// By how much d grad_S f / dp of a segment may differ between p and places within `step`, m = 3. Of others nothing is
/// known: infinite.
double edge_bend_change(const SegmentSkeleton&, const Profile&, double R, const Vec3d& p, double step);
inline double edge_bend_change(const auto&, const Profile&, double, const Vec3d&, double) { return Box3::inf; }

}  // namespace marrow
