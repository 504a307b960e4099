// Joints by sorting positions, then walks along unused segments.
#include "field/skeleton/branches.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

namespace marrow {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

// For each node the first node at its place.
std::vector<std::int32_t> joints_of(const std::vector<Vec3d>& positions) {
  const auto place = [&](std::int32_t i) {
    const Vec3d& p = positions[at(i)];
    return std::tie(p.x, p.y, p.z);
  };
  std::vector<std::int32_t> order(positions.size()), joints(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return std::tuple_cat(place(a), std::tie(a)) < std::tuple_cat(place(b), std::tie(b));
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && place(order[i]) == place(order[i - 1]);
    joints[at(order[i])] = is_same ? joints[at(order[i - 1])] : order[i];
  }
  return joints;
}

class Walker {
 public:
  Walker(const SkeletonGraph& graph, std::span<const std::int32_t> sticking)
      : joints_(joints_of(graph.positions)), is_end_(graph.positions.size(), false) {
    find_segments(graph);
    index_segments();
    for (std::size_t joint = 0; joint < is_end_.size(); ++joint) is_end_[joint] = degree(joint) != 2;
    for (const std::int32_t node : sticking) is_end_[at(joints_[at(node)])] = true;
  }

  Branches walk() && {
    for (std::size_t joint = 0; joint < is_end_.size(); ++joint)
      for (std::size_t i = first_[joint]; is_end_[joint] && i < first_[joint + 1]; ++i) follow(incident_[i]);
    for (std::size_t segment = 0; segment < segments_.size(); ++segment) follow({segment, 0});
    return std::move(found_);
  }

 private:
  /// A segment seen from one of its ends.
  struct Departure {
    std::size_t segment;
    std::size_t side;
  };

  std::size_t degree(std::size_t joint) const { return first_[joint + 1] - first_[joint]; }
  std::size_t joint_at(const Departure& d) const { return at(joints_[at(segments_[d.segment][d.side])]); }

  void find_segments(const SkeletonGraph& graph) {
    std::vector<bool> has_child(graph.positions.size(), false);
    for (std::size_t i = 0; i < graph.parents.size(); ++i) {
      const std::int32_t parent = graph.parents[i];
      if (parent == SkeletonGraph::no_parent) continue;
      has_child[at(parent)] = true;
      if (joints_[at(parent)] != joints_[i]) segments_.push_back({parent, static_cast<std::int32_t>(i)});
    }
    for (std::size_t i = 0; i < graph.parents.size(); ++i)
      if (graph.parents[i] == SkeletonGraph::no_parent && !has_child[i])
        found_.balls.push_back(static_cast<std::int32_t>(i));
    is_used_.assign(segments_.size(), false);
  }

  // Lists the segments of each joint, by counting.
  void index_segments() {
    first_.assign(joints_.size() + 1, 0);
    const auto for_each_end = [this](auto&& action) {
      for (std::size_t segment = 0; segment < segments_.size(); ++segment)
        for (const std::size_t side : {0u, 1u}) action(Departure{segment, side});
    };
    for_each_end([this](const Departure& d) { ++first_[joint_at(d) + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    incident_.resize(2 * segments_.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_each_end([&](const Departure& d) { incident_[next[joint_at(d)]++] = d; });
  }

  void follow(Departure d) {
    if (is_used_[d.segment]) return;
    const std::size_t begin = found_.nodes.size(), start = joint_at(d);
    found_.nodes.push_back(segments_[d.segment][d.side]);
    for (;;) {
      is_used_[d.segment] = true;
      const Departure arrival{d.segment, 1 - d.side};
      const std::size_t joint = joint_at(arrival);
      found_.nodes.push_back(segments_[arrival.segment][arrival.side]);
      if (is_end_[joint] || joint == start) break;
      const Departure& one = incident_[first_[joint]];
      d = one.segment == arrival.segment ? incident_[first_[joint] + 1] : one;
    }
    const bool is_closed = !is_end_[start] && found_.nodes.size() - begin > 3;
    if (is_closed) found_.nodes.pop_back();
    found_.paths.push_back({begin, found_.nodes.size(), is_closed});
  }

  std::vector<std::int32_t> joints_;
  std::vector<bool> is_end_, is_used_;
  std::vector<std::array<std::int32_t, 2>> segments_;
  std::vector<std::size_t> first_;
  std::vector<Departure> incident_;
  Branches found_;
};

}  // namespace

Branches branches_of(const SkeletonGraph& graph, std::span<const std::int32_t> sticking) {
  return Walker(graph, sticking).walk();
}

}  // namespace marrow
