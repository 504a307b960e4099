// Tables of point, segment, triangle, circle and arc; what they share is written once.
#include "renderer/scene/primitive_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "renderer/scene/drawn.h"

namespace marrow {
namespace {

template <class Skeleton>
Primitive primitive(const Drawn<Skeleton>& drawn) {
  return primitive_with(static_cast<const Skeleton&>(drawn), drawn);
}

const Table<Drawn<PointSkeleton>>& point_table() {
  using Point = Drawn<PointSkeleton>;
  static const Table<Point> table(
      "point", "A ball.",
      with_common_keys<PointSkeleton>(
          {key<Point>("at", &PointSkeleton::at, position(), "its centre").required(),
           key<Point>("radius", &PointSkeleton::radius, number(any_radius()), "of its surface when alone")}));
  return table;
}

// One radius everywhere, or one at each end; more than two never arrive here.
void set_radius(Drawn<SegmentSkeleton>& segment, const std::vector<double>& radii) {
  segment.radius_from = radii.front();
  segment.radius_to = radii.back();
}

const Table<Drawn<SegmentSkeleton>>& segment_table() {
  using Segment = Drawn<SegmentSkeleton>;
  static const Table<Segment> table(
      "segment", "A tube from one point to another whose radius changes evenly.",
      with_common_keys<SegmentSkeleton>(
          {key<Segment>("from", &SegmentSkeleton::from, position(), "one end").required(),
           key<Segment>("to", &SegmentSkeleton::to, position(), "the other end").required(),
           key<Segment>("radius", set_radius, radii(2, 2, "a radius above 0, or two: [at from, at to]"),
                        "of its surface when alone; 1 when left out")}),
      [](const Segment& s, const Value& v, Reader& reader) {
        if (s.from != s.to) return true;
        reader.error(v.place, "the segment has no length: `from` and `to` are equal", "a ball is `point: {at: …}`");
        return false;
      });
  return table;
}

const Table<Drawn<TriangleSkeleton>>& triangle_table() {
  using Triangle = Drawn<TriangleSkeleton>;
  static const Table<Triangle> table(
      "triangle", "A plate around a triangle whose thickness changes evenly.",
      with_common_keys<TriangleSkeleton>(
          {key<Triangle>(
               "vertices",
               [](Triangle& t, const std::vector<Vec3d>& v) { std::copy_n(v.begin(), 3, t.vertices.begin()); },
               list_of(position(), 3, 3), "its corners")
               .required(),
           key<Triangle>(
               "radius",
               [](Triangle& t, const std::vector<double>& r) {
                 if (r.size() == 1) t.radii.fill(r.front());
                 else std::copy_n(r.begin(), 3, t.radii.begin());
               },
               radii(3, 3, "a radius above 0, or one for each corner"),
               "half the thickness of a wide plate; 1 when left out")}));
  return table;
}

// A circle or an arc as it is written: axes of any length, angles in degrees.
struct Round : ArcSkeleton {
  std::array<double, 2> angles_deg{0, 360};
};
void set_axes(Drawn<Round>& round, const std::vector<Vec3d>& axes) {
  round.axis1 = axes[0];
  round.axis2 = axes[1];
}
std::vector<Key<Drawn<Round>>> round_keys() {
  using Arc = Drawn<Round>;
  return {key<Arc>("center", &ArcSkeleton::center, position(), "its centre"),
          key<Arc>("axes", set_axes, list_of(direction(), 2, 2),
                   "two directions at right angles, the first at angle 0; x and y when left out"),
          key<Arc>("major", &ArcSkeleton::major, number(any_radius()), "distance of the centre line from the centre")};
}
bool round_fits(const Drawn<Round>& round, const Value& v, Reader& reader) {
  // A degree of a millionth is no more than rounding of numbers with six digits.
  constexpr double right_angle = 1e-5;
  if (std::fabs(dot(normalize(round.axis1), normalize(round.axis2))) > right_angle) {
    reader.error(v.find("axes")->value.place, "the axes are not at right angles", "");
    return false;
  }
  // 512.2 - 152.2 is 6e-14 more than 360; compile() takes ten times as much more.
  constexpr double whole_turn = 360 * (1 + 1e-13);
  const auto [begin, end] = round.angles_deg;
  if (end > begin && end - begin <= whole_turn) return true;
  reader.error(v.find("angles")->value.place, "the angles must rise by at most 360 degrees", "");
  return false;
}

const Table<Drawn<Round>>& circle_table() {
  using Circle = Drawn<Round>;
  std::vector<Key<Circle>> keys = round_keys();
  keys.push_back(key<Circle>(
      "radius", [](Circle& c, double r) { c.radius_from = c.radius_to = r; }, number(any_radius()),
      "of the tube; 1 when left out"));
  static const Table<Circle> table("circle", "A ring.", with_common_keys<Round>(std::move(keys)), round_fits);
  return table;
}

const Table<Drawn<Round>>& arc_table() {
  using Arc = Drawn<Round>;
  std::vector<Key<Arc>> keys = round_keys();
  keys.push_back(key<Arc>(
                     "angles",
                     [](Arc& a, const std::vector<double>& angles) {
                       a.angles_deg = {angles[0], angles[1]};
                     },
                     list_of(degrees(any_number()), 2, 2), "where it begins and ends, in degrees")
                     .required());
  keys.push_back(key<Arc>(
      "radius",
      [](Arc& a, const std::vector<double>& r) {
        a.radius_from = r.front();
        a.radius_to = r.back();
      },
      radii(2, 2, "a radius above 0, or two: [at the begin, at the end]"), "of the tube; 1 when left out"));
  static const Table<Arc> table("arc", "A part of a ring whose radius changes evenly.",
                                with_common_keys<Round>(std::move(keys)), round_fits);
  return table;
}

Primitive arc_of(const Drawn<Round>& drawn) {
  constexpr double degree_in_radians = std::numbers::pi / 180;
  ArcSkeleton arc = drawn;
  const UnitVec3 first = normalize(arc.axis1);
  arc.axis1 = first.vec();
  arc.axis2 = normalize(arc.axis2 - first * dot(arc.axis2, first)).vec();
  arc.begin = drawn.angles_deg[0] * degree_in_radians;
  arc.end = drawn.angles_deg[1] * degree_in_radians;
  return primitive_with(arc, drawn);
}

}  // namespace

Form<std::vector<double>> radii(std::size_t min, std::size_t max, const std::string& words) {
  const Form<double> one = number(any_radius());
  return either<std::vector<double>>(
      {mapped<std::vector<double>>(one, [](double r) { return std::vector<double>{r}; }), list_of(one, min, max)},
      words);
}

Form<SkeletonModel> skeleton_model() {
  return choice<SkeletonModel>({{"integral", SkeletonModel::Integral},
                                {"distance", SkeletonModel::Distance},
                                {"cani_hornus", SkeletonModel::CaniHornus}});
}

Form<double> primitive_alpha() { return radians(between(-1, 1.57079632679489661923)); }

Form<Primitive> point_form() { return mapped<Primitive>(map_of(point_table()), primitive<PointSkeleton>); }
Form<Primitive> segment_form() { return mapped<Primitive>(map_of(segment_table()), primitive<SegmentSkeleton>); }
Form<Primitive> triangle_form() { return mapped<Primitive>(map_of(triangle_table()), primitive<TriangleSkeleton>); }
Form<Primitive> circle_form() { return mapped<Primitive>(map_of(circle_table()), arc_of); }
Form<Primitive> arc_form() { return mapped<Primitive>(map_of(arc_table()), arc_of); }

std::vector<const TableInfo*> primitive_tables() {
  return {&point_table().info, &segment_table().info, &triangle_table().info, &circle_table().info, &arc_table().info};
}

}  // namespace marrow
