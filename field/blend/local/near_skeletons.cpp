#include "field/blend/local/near_skeletons.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "field/blend/angle/local_contact.h"
#include "field/blend/primitive_visit.h"
#include "field/math/elementary.h"
#include "field/skeleton/distance.h"

namespace marrow {
namespace {

// Near fields are sums of so high powers of distances at most, those of surfaces.
constexpr int highest_power = LocalContact::near_degree + 1;
constexpr double rounded = 1 + 1e-9;

template <class Skeleton>
void append(const PrimitiveList<Skeleton>& from, PrimitiveList<Skeleton>& to) {
  to.skeletons.insert(to.skeletons.end(), from.skeletons.begin(), from.skeletons.end());
}

BlendField without_skeletons() {
  BlendField blend;
  blend.degree = LocalContact::near_degree;
  return blend;
}

// Of one skeleton anywhere in a ball, from what it is in the middle.
struct NearField {
  double least, most;
};

NearField near_field_around(double middle, double distance, double rho) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  if (!(distance > rho * rounded))
    return {distance > 0 ? middle / integer_power(1 + rho / distance, highest_power) : 0, inf};
  return {middle / integer_power(1 + rho / distance, highest_power),
          middle / integer_power(1 - rho / distance, highest_power) * rounded};
}

// The largest of the weakest, which may all be left out.
double strongest_left_out(const std::vector<NearField>& fields) {
  double least = 0;
  std::vector<double> most;
  most.reserve(fields.size());
  for (const NearField& f : fields) {
    least += f.least;
    most.push_back(f.most);
  }
  std::ranges::sort(most);
  double left_out = 0, strongest = -1;
  for (const double m : most) {
    left_out += m;
    if (!(left_out < NearSkeletons::most_left_out * least)) break;
    strongest = m;
  }
  return strongest;
}

}  // namespace

NearSkeletons::NearSkeletons(const BlendField& blend) : skeletons_(without_skeletons()) {
  append(blend.points, skeletons_.points);
  append(blend.segments, skeletons_.segments);
  append(blend.distance_segments, skeletons_.segments);
  append(blend.cani_hornus_segments, skeletons_.segments);
  append(blend.triangles, skeletons_.triangles);
  append(blend.distance_triangles, skeletons_.triangles);
  append(blend.arcs, skeletons_.arcs);
  append(blend.distance_arcs, skeletons_.arcs);
}

NearSkeletons NearSkeletons::within(const Box3& box) const {
  const Vec3d center = box.center();
  const double rho = 0.5 * length(box.size()) * rounded;
  std::vector<NearField> fields;
  fields.reserve(size());
  for_each_primitive<Derivatives::ScaleInvariant>(
      skeletons_, center, [&](const SkeletonSample& s, const auto& list, std::size_t i) {
        fields.push_back(near_field_around(s.value, distance_to(list.skeletons[i], center), rho));
      });
  const double strongest = strongest_left_out(fields);
  NearSkeletons made;
  made.skeletons_ = without_skeletons();
  auto field = fields.begin();
  const auto keep = [&](const auto& from, auto& to) {
    for (const auto& s : from.skeletons)
      if ((field++)->most > strongest) to.skeletons.push_back(s);
  };
  keep(skeletons_.points, made.skeletons_.points);
  keep(skeletons_.segments, made.skeletons_.segments);
  keep(skeletons_.triangles, made.skeletons_.triangles);
  keep(skeletons_.arcs, made.skeletons_.arcs);
  return made;
}

SkeletonSample NearSkeletons::at(const Vec3d& p) const { return sum_of_primitives<Derivatives::First>(skeletons_, p); }

double NearSkeletons::log_slope(const Vec3d& center, double rho) const {
  double nearest = std::numeric_limits<double>::infinity();
  skeletons_.for_each_list([&](const auto& list) {
    for (const auto& s : list.skeletons) nearest = std::min(nearest, distance_to(s, center));
  });
  return nearest > rho ? highest_power / (nearest - rho) * rounded : std::numeric_limits<double>::infinity();
}

}  // namespace marrow
