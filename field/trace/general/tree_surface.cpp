// What is there at a hit: the normal, a place outside for further rays, the material.
#include <algorithm>

#include "field/math/growing_steps.h"
#include "field/number/variables_at.h"
#include "field/trace/general/tree_fields.h"

namespace marrow {
namespace {

// By which sums over points are off (field/tree/README.md), those over all primitives, and where the surface goes on as
// another tracer has it, that of a blend that is lent.
constexpr double error_of_local_sums = 2e-7, rounding_of_sums = 1e-12, error_beside_lent = 2e-5;
constexpr double longest_step = 1e-3;  // of the cell, beside a hit
// Two members of a union meet at a hit where the other's field is within `of_joint` of 1 there. The normal is then
// taken `beside_joint` of the cell's size away from the hit, where sums tell which of the two has the larger field.
constexpr double of_joint = 1e-6, beside_joint = 1e-8;

}  // namespace

Interval TreeTracer::field_enclosed(const Cell& c, const Vec3d& p) const {
  return field_near(c, p, Vec3<Interval>{Interval(p.x), Interval(p.y), Interval(p.z)});
}

// The shortest of growing steps after which the field is certainly below 1, as far as what is summed is off from it.
// Where no bounds tell that within a thousandth of the cell, the shortest after which what is summed is certainly
// below 1, or is so by more than `likely`.
std::optional<Vec3d> TreeTracer::outside_along(const Cell& c, const Vec3d& position, const Vec3d& direction,
                                               double likely) const {
  const double off = error_at(c);
  std::optional<Vec3d> summed;
  const double shortest = shortest_step(c);
  const GrowingSteps steps{shortest, 4, std::max(longest_step * c.box.size().x, 64 * shortest)};
  const auto certain = first_place_along(position, direction, steps, [&](const Vec3d& p) {
    const Interval enclosed = field_enclosed(c, p);
    if (enclosed.hi < 1 - off) return true;
    if (!summed && (enclosed.hi < 1 - rounding_of_sums || (enclosed.lo < 1 && field_near(c, p, p) < 1 - likely)))
      summed = p;
    return false;
  });
  return certain ? certain : summed;
}

double TreeTracer::error_at(const Cell& c) const {
  if (lent() != nullptr) return error_beside_lent;
  return c.part != nullptr ? error_of_local_sums : rounding_of_sums;
}

double TreeTracer::shortest_step(const Cell& c) {
  return 4 * rounding::ulp * std::max(largest_coordinate(c.box), c.box.size().x);
}

// The same at once, where the slope tells how far it is: at nearly all hits.
std::optional<Vec3d> TreeTracer::outside_by_slope(const Cell& c, const Vec3d& position, const UnitVec3& normal,
                                                  double slope) const {
  const double off = error_at(c);
  const double step = std::max(1.5 * off / slope, shortest_step(c));
  if (!(step < longest_step * c.box.size().x)) return {};
  const Vec3d p = position + normal.vec() * step;
  return field_enclosed(c, p).hi < 1 - off ? std::optional(p) : std::nullopt;
}

// Where members meet, each may have an edge in a surface that is smooth: that of the whole, a little beside it on the
// ray, outside.
UnitVec3 TreeTracer::normal_at_joint(const Cell& c, const Vec3d& position, const Vec3d& along,
                                     const UnitVec3& of_member) const {
  using X = Jet<double, 3>;
  const double step = std::max(beside_joint * c.box.size().x, 64 * shortest_step(c));
  for (const double way : {-step, step}) {
    const Vec3d p = position + along * way;
    const X f = field_near(c, p, variables_at<X>(p));
    const Vec3d outward = -gradient_of(f);
    if (f.value < 1 && length(outward) > 0) return normalize(outward);
  }
  return of_member;
}

SurfacePoint TreeTracer::surface_at(std::size_t cell, const Vec3d& position, const Vec3d& along) const {
  using X = Jet<double, 3>;
  const Cell& c = cells_[cell];
  const Vec3<X> at = variables_at<X>(position);
  const X f = with_field_near(c, position,
                              [&](const FieldTree& tree, std::uint32_t record) { return value(tree, at, record); });
  const X others = largest_of_others(c.member, at);
  const auto outward = [](const X& g) { return normalize(-gradient_of(g)); };
  const UnitVec3 normal = others.value > 1 - of_joint ? normal_at_joint(c, position, along, outward(f)) : outward(f);
  if (const auto outside = outside_by_slope(c, position, normal, length(gradient_of(f))))
    return {.normal = normal, .outside = *outside, .around = {}};
  // Beside another member: away from both, or from one and back.
  const Vec3d away = others.value > 0 ? outward(others).vec() : normal.vec();
  const Vec3d ways[] = {normal, normal.vec() + away, -along, away - along, normal.vec() - along, along};
  for (const double likely : {1e-6, 1e-13})  // more than sums are off; no more than rounding
    for (const Vec3d& way : ways)
      if (const auto outside = outside_along(c, position, way, likely))
        return {.normal = normal, .outside = *outside, .around = {}};
  // At an edge of a face in whose plane the ray runs, all these ways may lie in it: aslant to all sides. Where the
  // field is level in that face, the normal by slopes is that of either side.
  const Frame frame = Frame::around(normal);
  for (const double z : {1, 0, -1})
    for (const double x : {-1, 0, 1})
      for (const double y : {-1, 0, 1}) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3d way = frame.to_world({x, y, z});
        if (const auto outside = outside_along(c, position, way, 1e-13))
          return {.normal = z < 0 ? normalize(way) : normal, .outside = *outside, .around = {}};
      }
  return {.normal = normal, .outside = position, .around = {}};
}

MaterialId TreeTracer::material_at(std::size_t cell, const Vec3d& position) const {
  if (only_material_) return *only_material_;
  return with_field_near(cells_[cell], position, [&](const FieldTree& tree, std::uint32_t record) {
    return strongest_material(tree, position, record);
  });
}

}  // namespace marrow
