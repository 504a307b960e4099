#include "field/blend/bounds/sum/least_field.h"

#include <algorithm>

#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

double farthest(const SegmentSkeleton& s, const Vec3d& p) { return std::max(length(p - s.from), length(p - s.to)); }
double farthest(const ArcSkeleton& s, const Vec3d& p) {
  return length(p - place_at(s, 0.5 * (s.begin + s.end))) + 0.5 * measure(s);
}
double farthest(const TriangleSkeleton& s, const Vec3d& p) {
  return std::max({length(p - s.vertices[0]), length(p - s.vertices[1]), length(p - s.vertices[2])});
}

// Of each part the kernel of the largest distance over the least radius, over the largest radius. After so many cuts
// parts are cut where they are longer than the box is away from them: there a small part tells what is inside of all
// that lies around a large skeleton. Parts of `finest` radii do for that.
template <class Skeleton>
double least_of_parts(const Skeleton& s, const Profile& profile, const Vec3d& center, double rho, int cuts) {
  constexpr int most_cuts = 12;
  constexpr double finest = 0.3;
  const double far = farthest(s, center) + rho, size = extent(s), least = least_radius(s);
  const bool is_long = 2 * size > far && size > finest * least;
  if (cuts > 0 || (is_long && cuts > -most_cuts)) {
    double sum = 0;
    for (const Skeleton& part : parts(s)) sum += least_of_parts(part, profile, center, rho, cuts - 1);
    return sum;
  }
  const double radius = largest_radius(s), x = far / least;
  const double over_radius = measure(s) / (dimension_of(s) == 2 ? radius * radius : radius);
  return over_radius * profile.at(x * x).value / profile.normalisation() * (1 - 1e-9);
}

}  // namespace

double least_field(const SegmentSkeleton& s, const Profile& profile, const Vec3d& center, double rho) {
  return least_of_parts(s, profile, center, rho, 3);
}
double least_field(const ArcSkeleton& s, const Profile& profile, const Vec3d& center, double rho) {
  return least_of_parts(s, profile, center, rho, 3);
}
double least_field(const TriangleSkeleton& s, const Profile& profile, const Vec3d& center, double rho) {
  return least_of_parts(s, profile, center, rho, 2);
}

}  // namespace marrow
