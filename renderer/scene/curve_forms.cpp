// The tables of polyline and curve, and what several of their keys must have in common.
#include "renderer/scene/curve_forms.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "field/skeleton/curve_graph.h"
#include "renderer/scene/drawn.h"

namespace marrow {
namespace {

struct WrittenPolyline : PolylineSkeleton {
  bool closed = false;
};
struct WrittenCurve : CurveSkeleton {
  std::vector<std::vector<int>> branches;
};
using Polyline = Drawn<WrittenPolyline>;
using Curve = Drawn<WrittenCurve>;

// One radius for all points or one for each; three points where the last is joined to the first.
template <class Line>
bool line_fits(const Line& line, const Value& v, Reader& reader) {
  const std::string points = std::to_string(line.points.size());
  if (line.closed && line.points.size() < 3) {
    reader.error(v.find("closed")->place, "a closed line needs three points, not " + points, "");
    return false;
  }
  if (line.radii.size() == 1 || line.radii.size() == line.points.size()) return true;
  reader.error(v.find("radius")->value.place, points + " points but " + std::to_string(line.radii.size()) + " radii",
               "give one radius for each point, or one number for all");
  return false;
}

template <class Line>
void give_all_radii(Line& line) {
  if (line.radii.size() == 1) line.radii.resize(line.points.size(), line.radii.front());
}

Form<std::vector<double>> line_radii() { return radii(2, no_limit, "a radius above 0, or one for each point"); }
Form<int> point_index() { return integer(0, std::numeric_limits<int>::max()); }

const Table<Polyline>& polyline_table() {
  static const Table<Polyline> table(
      "polyline", "Segments one after another.",
      with_common_keys<WrittenPolyline>(
          {key<Polyline>("points", &PolylineSkeleton::points, list_of(position(), 2), "in order").required(),
           key<Polyline>("radius", &PolylineSkeleton::radii, line_radii(), "of its surface when alone").required(),
           key<Polyline>("closed", &WrittenPolyline::closed, boolean(), "joins the last point to the first")}),
      line_fits<Polyline>);
  return table;
}

// A point that is named must exist; `list` is where it is named.
bool points_exist(const std::vector<int>& indices, const Curve& curve, const Value& list, Reader& reader) {
  bool exist = true;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (static_cast<std::size_t>(indices[i]) < curve.points.size()) continue;
    reader.error(
        list.items[i].place,
        "no joint " + std::to_string(indices[i]) + ": the curve has " + std::to_string(curve.points.size()) + " points",
        "joints are counted from 0");
    exist = false;
  }
  return exist;
}

bool branches_fit(const Curve& curve, const Value& v, Reader& reader) {
  const Member* branches = v.find("branches");
  if (!branches) return true;
  bool fit = true;
  std::vector<bool> is_used(curve.points.size(), false);
  for (std::size_t i = 0; i < curve.branches.size(); ++i) {
    fit = points_exist(curve.branches[i], curve, branches->value.items[i], reader) && fit;
    for (const int point : curve.branches[i])
      if (static_cast<std::size_t>(point) < is_used.size()) is_used[static_cast<std::size_t>(point)] = true;
  }
  const auto unused = std::find(is_used.begin(), is_used.end(), false);
  if (unused != is_used.end()) {
    reader.error(branches->place, "point " + std::to_string(unused - is_used.begin()) + " is in none of the branches",
                 "");
    fit = false;
  }
  if (!curve.closed) return fit;
  reader.error(v.find("closed")->place, "`closed` is for a curve without branches",
               "a branch closes where it returns to its first point");
  return false;
}

bool curve_fits(const Curve& curve, const Value& v, Reader& reader) {
  bool fit = line_fits(curve, v, reader);
  if (const Member* sticking = v.find("sticking"))
    fit = points_exist(curve.sticking, curve, sticking->value, reader) && fit;
  fit = branches_fit(curve, v, reader) && fit;
  std::size_t joints = curve.points.size();
  for (const auto& branch : curve.branches) joints += branch.size();
  return fit && reader.spend_nodes(joints << curve.levels, v.place);
}

const Table<Curve>& curve_table() {
  static const Table<Curve> table(
      "curve",
      "A smooth curve, or a graph of curves: segments refined by subdivision (Cani and Hornus 2001). A curve passes "
      "through its ends; branches pass through the points where they meet.",
      with_common_keys<WrittenCurve>(
          {key<Curve>("points", &CurveSkeleton::points, list_of(position(), 2), "control points in order").required(),
           key<Curve>("radius", &CurveSkeleton::radii, line_radii(),
                      "of its surface when alone; refined like the points")
               .required(),
           key<Curve>("subdivision", &CurveSkeleton::subdivision, subdivision_name(),
                      "toward the quadratic (`chaikin`) or the cubic B-spline"),
           key<Curve>("levels", &CurveSkeleton::levels, integer(0, CurveSkeleton::max_levels),
                      "level of detail: each doubles the segments"),
           key<Curve>("sticking", &CurveSkeleton::sticking, list_of(point_index()),
                      "points that stay as they are, counted from 0; the curve passes through them with a corner"),
           key<Curve>("closed", &CurveSkeleton::closed, boolean(), "joins the last point to the first"),
           key<Curve>("branches", &WrittenCurve::branches, list_of(list_of(point_index(), 2), 1),
                      "curves along points, which are counted from 0; one along all of them when left out")}),
      curve_fits);
  return table;
}

/// Puts branches along points into a skeleton. A branch that passes a point in use gets a second node there.
struct BranchedGraph {
  SkeletonGraph graph;
  std::vector<std::int32_t> node_of;  ///< of each point

  explicit BranchedGraph(const WrittenCurve& curve) : node_of(curve.points.size(), -1) {
    for (const std::vector<int>& branch : curve.branches) {
      std::int32_t last = node_of[static_cast<std::size_t>(branch.front())];
      for (std::size_t i = last < 0 ? 0 : 1; i < branch.size(); ++i) {
        const auto point = static_cast<std::size_t>(branch[i]);
        graph.positions.push_back(curve.points[point]);
        graph.radii.push_back(curve.radii[point]);
        graph.parents.push_back(last);
        last = node_of[point] = static_cast<std::int32_t>(graph.positions.size()) - 1;
      }
    }
  }
};

SkeletonGraph branched_and_subdivided(const WrittenCurve& curve) {
  const BranchedGraph branched(curve);
  std::vector<std::int32_t> sticking;
  for (const int point : curve.sticking) sticking.push_back(branched.node_of[static_cast<std::size_t>(point)]);
  return subdivide(branched.graph, curve.subdivision, curve.levels, sticking);
}

Primitive curve_primitive(Curve curve) {
  give_all_radii(curve);
  if (curve.branches.empty()) return primitive_with(static_cast<const CurveSkeleton&>(curve), curve);
  SharedSkeletonGraph graph = std::make_shared<const SkeletonGraph>(branched_and_subdivided(curve));
  // What is given for each point is refined as the radii are, in their place.
  WrittenCurve carrier = curve;
  for (Attribute& attribute : curve.attributes) {
    if (attribute.values.size() != curve.points.size()) continue;
    carrier.radii = attribute.values;
    attribute.values = branched_and_subdivided(carrier).radii;
  }
  return primitive_with(std::move(graph), curve);
}

Primitive polyline_primitive(Polyline line) {
  give_all_radii(line);
  if (line.closed) {
    for (Attribute& attribute : line.attributes)
      if (attribute.values.size() == line.points.size()) attribute.values.push_back(double(attribute.values.front()));
    line.points.push_back(Vec3d(line.points.front()));
    line.radii.push_back(double(line.radii.front()));
  }
  return primitive_with(static_cast<const PolylineSkeleton&>(line), line);
}

}  // namespace

Form<Subdivision> subdivision_name() {
  return choice<Subdivision>({{"chaikin", Subdivision::Chaikin}, {"cubic", Subdivision::Cubic}});
}

Form<Primitive> polyline_form() { return mapped<Primitive>(map_of(polyline_table()), polyline_primitive); }
Form<Primitive> curve_form() { return mapped<Primitive>(map_of(curve_table()), curve_primitive); }

std::vector<const TableInfo*> curve_tables() { return {&polyline_table().info, &curve_table().info}; }

}  // namespace marrow
