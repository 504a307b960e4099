// Tables of point, segment, polyline, curve and skeleton; what they share is written once.
#include "renderer/scene/primitive_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "renderer/scene/alpha_forms.h"
#include "renderer/scene/files/swc.h"
#include "renderer/scene/scalar.h"

namespace marrow {
namespace {

// A skeleton with what every primitive may say. The skeleton is a base so that its members can be bound as they are.
template <class Skeleton>
struct Drawn : Skeleton {
  std::optional<SkeletonModel> model;
  std::optional<double> alpha;
  std::optional<std::array<double, 2>> alpha_bounds;
  std::vector<Attribute> attributes;
  MaterialId material;
};

template <class Skeleton>
std::vector<Key<Drawn<Skeleton>>> with_common_keys(std::vector<Key<Drawn<Skeleton>>> keys) {
  using Owner = Drawn<Skeleton>;
  keys.push_back(key<Owner>("model", &Owner::model, skeleton_model(), "its field; the blend's when left out"));
  keys.push_back(key<Owner>("alpha", &Owner::alpha, primitive_alpha(),
                            "in radians, for `alpha: per_skeleton`; contact when left out"));
  keys.push_back(key<Owner>("alpha_bounds", &Owner::alpha_bounds, direction_bounds_form(),
                            "for `alpha: {direction: …}`; the blend's when left out"));
  keys.push_back(key<Owner>("attributes", &Owner::attributes, attributes_form(),
                            "numbers by name, one for all or one for each point, for `alpha: {attribute: …}`"));
  keys.push_back(key<Owner>("material", &Owner::material, material_name(), "the object's when left out"));
  return keys;
}

template <class Skeleton>
Primitive common_of(const Drawn<Skeleton>& drawn) {
  return {.skeleton = {},
          .model = drawn.model,
          .alpha = drawn.alpha,
          .alpha_bounds = drawn.alpha_bounds,
          .attributes = drawn.attributes,
          .material = drawn.material};
}

template <class Skeleton>
Primitive primitive(Drawn<Skeleton> drawn) {
  Primitive made = common_of(drawn);
  made.skeleton = static_cast<Skeleton&&>(std::move(drawn));
  return made;
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

Form<std::vector<double>> radii(std::size_t min, std::size_t max, const std::string& words) {
  const Form<double> one = number(any_radius());
  return either<std::vector<double>>(
      {mapped<std::vector<double>>(one, [](double r) { return std::vector<double>{r}; }), list_of(one, min, max)},
      words);
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

// One radius for all points or one for each.
template <class Line>
bool radii_fit(const Line& line, const Value& v, Reader& reader) {
  if (line.radii.size() == 1 || line.radii.size() == line.points.size()) return true;
  const Member* radius = v.find("radius");
  reader.error(radius->value.place,
               std::to_string(line.points.size()) + " points but " + std::to_string(line.radii.size()) + " radii",
               "give one radius for each point, or one number for all");
  return false;
}
template <class Line>
Primitive with_all_radii(Drawn<Line> line) {
  if (line.radii.size() == 1) line.radii.resize(line.points.size(), line.radii.front());
  return primitive<Line>(std::move(line));
}

const Table<Drawn<PolylineSkeleton>>& polyline_table() {
  using Polyline = Drawn<PolylineSkeleton>;
  static const Table<Polyline> table(
      "polyline", "Segments one after another.",
      with_common_keys<PolylineSkeleton>(
          {key<Polyline>("points", &PolylineSkeleton::points, list_of(position(), 2), "in order").required(),
           key<Polyline>("radius", &PolylineSkeleton::radii,
                         radii(2, no_limit, "a radius above 0, or one for each point"), "of its surface when alone")
               .required()}),
      radii_fit<Polyline>);
  return table;
}

bool joints_fit(const Drawn<CurveSkeleton>& curve, const Value& v, Reader& reader) {
  bool fit = radii_fit(curve, v, reader);
  for (std::size_t i = 0; i < curve.sticking.size(); ++i) {
    if (static_cast<std::size_t>(curve.sticking[i]) < curve.points.size()) continue;
    reader.error(v.find("sticking")->value.items[i].place,
                 "no joint " + std::to_string(curve.sticking[i]) + ": the curve has " +
                     std::to_string(curve.points.size()) + " points",
                 "joints are counted from 0");
    fit = false;
  }
  return fit && reader.spend_nodes(curve.points.size() << curve.levels, v.place);
}

const Table<Drawn<CurveSkeleton>>& curve_table() {
  using Curve = Drawn<CurveSkeleton>;
  static const Table<Curve> table(
      "curve", "A smooth curve: segments refined by subdivision (Cani and Hornus 2001). It passes through its ends.",
      with_common_keys<CurveSkeleton>(
          {key<Curve>("points", &CurveSkeleton::points, list_of(position(), 2), "control points in order").required(),
           key<Curve>("radius", &CurveSkeleton::radii, radii(2, no_limit, "a radius above 0, or one for each point"),
                      "of its surface when alone; refined like the points")
               .required(),
           key<Curve>("subdivision", &CurveSkeleton::subdivision,
                      choice<Subdivision>({{"chaikin", Subdivision::Chaikin}, {"cubic", Subdivision::Cubic}}),
                      "toward the quadratic (`chaikin`) or the cubic B-spline"),
           key<Curve>("levels", &CurveSkeleton::levels, integer(0, CurveSkeleton::max_levels),
                      "level of detail: each doubles the segments"),
           key<Curve>("sticking", &CurveSkeleton::sticking, list_of(integer(0, std::numeric_limits<int>::max())),
                      "points that stay as they are, counted from 0; the curve passes through them with a corner")}),
      joints_fit);
  return table;
}

const Table<Drawn<TriangleSkeleton>>& triangle_table() {
  using Triangle = Drawn<TriangleSkeleton>;
  static const Table<Triangle> table(
      "triangle", "A plate around a triangle whose thickness changes evenly. `probe` and `slice` only, for now.",
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
  const auto [begin, end] = round.angles_deg;
  if (end > begin && end - begin <= 360) return true;
  reader.error(v.find("angles")->value.place, "the angles must rise by at most 360 degrees", "");
  return false;
}

const Table<Drawn<Round>>& circle_table() {
  using Circle = Drawn<Round>;
  std::vector<Key<Circle>> keys = round_keys();
  keys.push_back(key<Circle>(
      "radius", [](Circle& c, double r) { c.radius_from = c.radius_to = r; }, number(any_radius()),
      "of the tube; 1 when left out"));
  static const Table<Circle> table("circle", "A ring. `probe` and `slice` only, for now.",
                                   with_common_keys<Round>(std::move(keys)), round_fits);
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
  static const Table<Arc> table("arc",
                                "A part of a ring whose radius changes evenly. `probe` and `slice` only, for now.",
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
  Primitive made = common_of(drawn);
  made.skeleton = arc;
  return made;
}

struct SkeletonFile {
  std::filesystem::path file;
  double scale = 1;
  std::optional<double> min_radius;
};
const Table<Drawn<SkeletonFile>>& skeleton_table() {
  using File = Drawn<SkeletonFile>;
  static const Table<File> table(
      "skeleton", "All branches of an SWC file.",
      with_common_keys<SkeletonFile>(
          {key<File>("file", &SkeletonFile::file, file_name(), "an .swc file, relative to this one").required(),
           key<File>("scale", &SkeletonFile::scale, number(any_radius()), "multiplies positions and radii"),
           key<File>("min_radius", &SkeletonFile::min_radius, number(any_radius()),
                     "thinner places are made this thick; in scene units, after `scale`")}));
  return table;
}

SharedSkeletonGraph load(const SkeletonFile& wanted, const Place& at, Reader& reader) {
  const std::string id = wanted.file.string() + '\n' + number_text(wanted.scale) + '\n' +
                         (wanted.min_radius ? number_text(*wanted.min_radius) : "");
  const auto known = reader.skeletons.find(id);
  if (known != reader.skeletons.end()) return known->second;
  SharedSkeletonGraph& graph = reader.skeletons[id];  // stays null after a mistake, so that it is reported once
  auto file = reader.open(wanted.file, at);
  if (!file) return graph;
  auto swc = read_swc(file->bytes, {.scale = wanted.scale, .min_radius = wanted.min_radius}, wanted.file.string());
  if (swc) graph = std::make_shared<const SkeletonGraph>(std::move(swc->graph));
  reader.report_file(wanted.file, std::move(file->bytes), swc ? swc->warnings : swc.why());
  return graph;
}

Primitive with_graph(const Drawn<SkeletonFile>& drawn, SharedSkeletonGraph graph) {
  Primitive made = common_of(drawn);
  made.skeleton = std::move(graph);
  return made;
}

}  // namespace

Form<SkeletonModel> skeleton_model() {
  return choice<SkeletonModel>({{"integral", SkeletonModel::Integral},
                                {"distance", SkeletonModel::Distance},
                                {"cani_hornus", SkeletonModel::CaniHornus}});
}

Form<double> primitive_alpha() { return radians(between(-1, 1.57079632679489661923)); }

Form<Primitive> point_form() { return mapped<Primitive>(map_of(point_table()), primitive<PointSkeleton>); }
Form<Primitive> segment_form() { return mapped<Primitive>(map_of(segment_table()), primitive<SegmentSkeleton>); }
Form<Primitive> polyline_form() {
  return mapped<Primitive>(map_of(polyline_table()), with_all_radii<PolylineSkeleton>);
}
Form<Primitive> curve_form() { return mapped<Primitive>(map_of(curve_table()), with_all_radii<CurveSkeleton>); }

Form<Primitive> triangle_form() { return mapped<Primitive>(map_of(triangle_table()), primitive<TriangleSkeleton>); }
Form<Primitive> circle_form() { return mapped<Primitive>(map_of(circle_table()), arc_of); }
Form<Primitive> arc_form() { return mapped<Primitive>(map_of(arc_table()), arc_of); }

Form<Primitive> skeleton_form() {
  const Form<Drawn<SkeletonFile>> map = map_of(skeleton_table());
  Form<Primitive> form = mapped<Primitive>(map, [](const Drawn<SkeletonFile>&) { return Primitive{}; });
  form.read = [map](const Value& v, Reader& reader) -> std::optional<Primitive> {
    const auto wanted = map.read(v, reader);
    if (!wanted) return std::nullopt;
    const Member* file = v.find("file");
    auto graph = load(*wanted, file->value.place, reader);
    return graph ? std::optional(with_graph(*wanted, std::move(graph))) : std::nullopt;
  };
  return form;
}

std::vector<const TableInfo*> primitive_tables() {
  return {&point_table().info,    &segment_table().info, &polyline_table().info, &curve_table().info,
          &triangle_table().info, &circle_table().info,  &arc_table().info,      &skeleton_table().info};
}

}  // namespace marrow
