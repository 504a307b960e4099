// The rules for positions and radii that all skeleton files share.
#include "renderer/scene/files/node_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "renderer/scene/finite_number.h"

namespace marrow {

namespace {
constexpr double largest = 1e15;  // as every number of a scene
constexpr const char* hint_of_largest = "nothing in a scene may be larger than 1e15";
}  // namespace

void refuse_beyond(double in_scene_units, const char* place, FileProblems& problems) {
  if (std::fabs(in_scene_units) <= largest) return;
  const std::string_view word = problems.word_at(place);
  const bool is_scaled = finite_number(word) != in_scene_units;
  problems.complain(word,
                    fmt::format("{} lies beyond 1e15 scene units{}", quoted_word(word),
                                is_scaled ? fmt::format(", scaled to {:.3g}", in_scene_units) : ""),
                    hint_of_largest);
}

void NodeList::reserve(std::size_t nodes) {
  nodes = std::min(nodes, max_nodes);
  graph_.positions.reserve(nodes);
  graph_.radii.reserve(nodes);
  graph_.parents.reserve(nodes);
}

void NodeList::check_last(const NodePlaces& places) {
  const Vec3d& p = graph_.positions.back();
  const double radius = graph_.radii.back();
  if (places.at[0] != nullptr) {
    for (std::size_t axis = 0; axis < 3; ++axis) refuse_beyond(p[axis], places.at[axis], problems_);
    if (!options_.radius) refuse_beyond(radius, places.radius, problems_);
  } else if (!(max_component(abs(p)) <= largest && radius <= largest)) {
    problems_.complain_of_file(fmt::format("node {} lies beyond 1e15 scene units", size()), hint_of_largest);
  }
  if (size() > max_nodes) problems_.give_up(places.at[0], fmt::format("the file has more than {} nodes", max_nodes));
}

void NodeList::add(const Vec3d& at, double radius, const NodePlaces& places) {
  if (radius < 0)
    problems_.complain(places.radius, fmt::format("the radius {} is negative", radius),
                       "a radius is above 0, or 0 where it is not known");
  graph_.positions.push_back(at * options_.scale);
  graph_.radii.push_back(options_.radius.value_or(radius * options_.scale * options_.radius_scale));
  check_last(places);
}

void NodeList::add(const Vec3d& at, double radius, std::int32_t parent, const NodePlaces& places) {
  add(at, radius, places);
  graph_.parents.push_back(parent);
}

void NodeList::add_in_scene_units(const Vec3d& at_in_file, double radius, std::int32_t parent) {
  graph_.positions.push_back(at_in_file * options_.scale);
  graph_.radii.push_back(radius);
  graph_.parents.push_back(parent);
  check_last({});
}

SkeletonFile NodeList::finish() && {
  SkeletonFile made;
  const auto zeros = std::count(graph_.radii.begin(), graph_.radii.end(), 0.0);
  double floor = options_.min_radius.value_or(0);
  if (zeros > 0 && !options_.min_radius) {
    floor = std::numeric_limits<double>::infinity();
    for (const double r : graph_.radii)
      if (r > 0) floor = std::min(floor, r);
    if (std::isinf(floor)) {
      problems_.complain_of_file("every radius of the file is 0", "give the skeleton a `radius` or a `min_radius`");
      return made;
    }
    made.warnings.push_back(problems_.warning(
        fmt::format("{} of {} nodes have the radius 0; they get the smallest other radius of the file, {} scene units",
                    zeros, graph_.radii.size(), floor),
        "choose it with `min_radius`"));
  }
  for (double& r : graph_.radii) r = std::max(r, floor);
  made.graph = std::move(graph_);
  return made;
}

}  // namespace marrow
