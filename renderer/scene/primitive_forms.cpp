// Tables of point, segment, polyline and skeleton; what they share is written once.
#include "renderer/scene/primitive_forms.h"

#include <memory>

#include "renderer/scene/files/swc.h"
#include "renderer/scene/scalar.h"

namespace marrow {
namespace {

// A skeleton with what every primitive may say. The skeleton is a base so that its members can be bound as they are.
template <class Skeleton>
struct Drawn : Skeleton {
  std::optional<SkeletonModel> model;
  std::optional<double> alpha;
  MaterialId material;
};

template <class Skeleton>
std::vector<Key<Drawn<Skeleton>>> with_common_keys(std::vector<Key<Drawn<Skeleton>>> keys) {
  using Owner = Drawn<Skeleton>;
  keys.push_back(key<Owner>("model", &Owner::model, skeleton_model(), "its field; the blend's when left out"));
  keys.push_back(key<Owner>("alpha", &Owner::alpha, primitive_alpha(), "in radians, for `alpha: per_skeleton`"));
  keys.push_back(key<Owner>("material", &Owner::material, material_name(), "the object's when left out"));
  return keys;
}

template <class Skeleton>
Primitive primitive(Drawn<Skeleton> drawn) {
  Primitive made{.skeleton = {}, .model = drawn.model, .alpha = drawn.alpha, .material = drawn.material};
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

const Table<Drawn<PolylineSkeleton>>& polyline_table() {
  using Polyline = Drawn<PolylineSkeleton>;
  static const Table<Polyline> table(
      "polyline", "Segments one after another.",
      with_common_keys<PolylineSkeleton>(
          {key<Polyline>("points", &PolylineSkeleton::points, list_of(position(), 2), "in order").required(),
           key<Polyline>("radius", &PolylineSkeleton::radii,
                         radii(2, no_limit, "a radius above 0, or one for each point"), "of its surface when alone")
               .required()}),
      [](const Polyline& line, const Value& v, Reader& reader) {
        if (line.radii.size() == 1 || line.radii.size() == line.points.size()) return true;
        const Member* radius = v.find("radius");
        reader.error(radius->value.place,
                     std::to_string(line.points.size()) + " points but " + std::to_string(line.radii.size()) + " radii",
                     "give one radius for each point, or one number for all");
        return false;
      });
  return table;
}
PolylineSkeleton with_all_radii(PolylineSkeleton line) {
  if (line.radii.size() == 1) line.radii.resize(line.points.size(), line.radii.front());
  return line;
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
  return {.skeleton = std::move(graph), .model = drawn.model, .alpha = drawn.alpha, .material = drawn.material};
}

}  // namespace

Form<SkeletonModel> skeleton_model() {
  return choice<SkeletonModel>({{"integral", SkeletonModel::Integral}, {"distance", SkeletonModel::Distance}});
}

Form<double> primitive_alpha() { return radians(between(-1, 1.57079632679489661923)); }

Form<Primitive> point_form() { return mapped<Primitive>(map_of(point_table()), primitive<PointSkeleton>); }
Form<Primitive> segment_form() { return mapped<Primitive>(map_of(segment_table()), primitive<SegmentSkeleton>); }
Form<Primitive> polyline_form() {
  return mapped<Primitive>(map_of(polyline_table()), [](Drawn<PolylineSkeleton> drawn) {
    Primitive made = primitive<PolylineSkeleton>(std::move(drawn));
    made.skeleton = with_all_radii(std::get<PolylineSkeleton>(std::move(made.skeleton)));
    return made;
  });
}

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
  return {&point_table().info, &segment_table().info, &polyline_table().info, &skeleton_table().info};
}

}  // namespace marrow
