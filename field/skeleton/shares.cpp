// Shares of nodes and directions of arcs, by the quadratures of the fields themselves or at the nearest place.
#include "field/skeleton/shares.h"

#include <algorithm>

#include "field/skeleton/corners.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/nearest_place.h"
#include "field/skeleton/on_skeleton.h"
#include "field/skeleton/surface_integral.h"

namespace marrow {
namespace {

struct ShareSum : SkeletonSample {
  Shares shares{};
  DirectionSample direction;
  ShareSum& operator+=(const ShareSum& b) {
    SkeletonSample::operator+=(b);
    for (std::size_t k = 0; k < shares.size(); ++k) add(shares[k], b.shares[k].value, b.shares[k].gradient);
    direction.value += b.direction.value;
    direction.jacobian += b.direction.jacobian;
    return *this;
  }
  static void add(ShareSample& share, double value, const Vec3d& gradient) {
    share.value += value;
    share.gradient += gradient;
  }
  void add_node(const SkeletonSample& part, std::size_t k, double s) {
    add(shares[k], part.value * s, part.gradient * s);
  }
};

ShareSum along(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family == KernelFamily::Inverse && distance_to(arc, p) == 0) return {};
  const Profile profile(kernel, 1);
  const Vec3d axis = cross(arc.axis1, arc.axis2), from_center = p - arc.center;
  const ShareSum all = integrate_arc<ShareSum>(
      arc, p, kernel, [&](const Vec3d& v, double tau, double share, double weight, ShareSum& sum) {
        SkeletonSample part;
        add_source<Derivatives::First>(profile, v, tau, weight / (profile.normalisation() * tau), part);
        static_cast<SkeletonSample&>(sum) += part;
        sum.add_node(part, 0, share);
        const Vec3d tangent = cross(axis, from_center - v) / arc.major;
        sum.direction.value += tangent * part.value;
        sum.direction.jacobian += Matrix3::outer(tangent, part.gradient);
      });
  return all.value <= field_ceiling ? all : ShareSum{};
}

Shares weighted(Shares at, const SkeletonSample& field) {
  for (ShareSample& s : at) s = {field.value * s.value, s.gradient * field.value + field.gradient * s.value};
  return at;
}

}  // namespace

Shares integral_shares(const PointSkeleton&, const Vec3d&, const Kernel&) { return {}; }
Shares integral_shares(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return {segment_share(s, p, kernel), {}};
}
Shares integral_shares(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  return along(arc, p, kernel).shares;
}
Shares integral_shares(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  if (is_on(triangle, p, kernel)) return {};
  const Profile profile(kernel, 2);
  const Corners corners(triangle);
  const Vec3d from_corner = p - triangle.vertices[0];
  return integrate_triangle<ShareSum>(triangle, p, kernel,
                                      [&](const Vec3d& v, double tau, double weight, ShareSum& sum) {
                                        SkeletonSample part;
                                        add_source<Derivatives::First>(
                                            profile, v, tau, weight / (profile.normalisation() * tau * tau), part);
                                        static_cast<SkeletonSample&>(sum) += part;
                                        for (std::size_t k = 0; k < 2; ++k)
                                          sum.add_node(part, k, dot(from_corner - v, corners.dual[k]));
                                      })
      .shares;
}

Shares nearest_shares(const SegmentSkeleton& s, const Vec3d& p, const SkeletonSample& field) {
  return weighted(nearest_place(s, p).shares, field);
}
Shares nearest_shares(const TriangleSkeleton& s, const Vec3d& p, const SkeletonSample& field) {
  return weighted(nearest_place(s, p).shares, field);
}
Shares nearest_shares(const ArcSkeleton& s, const Vec3d& p, const SkeletonSample& field) {
  return weighted(nearest_place(s, p).shares, field);
}
Shares foot_shares(const SegmentSkeleton& s, const Vec3d& p, const SkeletonSample& field) {
  const Vec3d along = s.to - s.from;
  const double foot = dot(p - s.from, along) / length_squared(along);
  const bool moves = foot > 0 && foot < 1;
  const ShareSample at{std::clamp(foot, 0.0, 1.0), moves ? along / length_squared(along) : Vec3d{}};
  return weighted({at, {}}, field);
}

DirectionSample arc_direction(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  return along(arc, p, kernel).direction;
}
DirectionSample nearest_direction(const ArcSkeleton& arc, const Vec3d& p, const SkeletonSample& field) {
  const NearestPlace q = nearest_place(arc, p);
  const Vec3d axis = cross(arc.axis1, arc.axis2) / arc.major, u = cross(axis, p - arc.center - q.to_point);
  DirectionSample d{u * field.value, Matrix3::outer(u, field.gradient)};
  const auto& m = q.moves.rows;  // the rows of [axis x] moves
  const Matrix3 turns{{m[2] * axis.y - m[1] * axis.z, m[0] * axis.z - m[2] * axis.x, m[1] * axis.x - m[0] * axis.y}};
  d.jacobian += turns * field.value;
  return d;
}

}  // namespace marrow
