// Ids are sorted, unless they are already, and looked up.
#include "renderer/scene/files/parents.h"

#include <algorithm>
#include <numeric>

#include <fmt/core.h>

namespace marrow {
namespace {

class Linker {
 public:
  Linker(const std::vector<NamedNode>& nodes, FileProblems& problems) : nodes_(nodes), problems_(problems) {}

  std::vector<std::int32_t> link() {
    if (nodes_.empty()) return {};
    sort_ids();
    parents_.reserve(nodes_.size());
    for (const NamedNode& child : nodes_) parents_.push_back(parent_of(child));
    refuse_circles();
    return std::move(parents_);
  }

 private:
  const NamedNode& node(std::int32_t index) const { return nodes_[static_cast<std::size_t>(index)]; }

  void sort_ids() {
    order_.resize(nodes_.size());
    std::iota(order_.begin(), order_.end(), 0);
    const auto less = [this](std::int32_t a, std::int32_t b) { return node(a).id < node(b).id; };
    if (!std::is_sorted(order_.begin(), order_.end(), less)) std::stable_sort(order_.begin(), order_.end(), less);
    for (std::size_t first = 0, i = 1; i < order_.size() && !problems_.is_full(); ++i) {
      const NamedNode &one = node(order_[first]), &other = node(order_[i]);
      if (one.id != other.id) first = i;
      else
        problems_.complain(other.id_place, fmt::format("the id {} is given twice", other.id),
                           fmt::format("it stands first in line {}", problems_.line_of(one.id_place)));
    }
  }

  std::int32_t parent_of(const NamedNode& child) {
    if (child.parent < 0 && child.parent != child.id) return -1;
    // Where ids count up by one, the place is known; else search.
    const std::int64_t guess = child.parent - node(order_.front()).id;
    const bool is_hit = guess >= 0 && guess < static_cast<std::int64_t>(order_.size()) &&
                        node(order_[static_cast<std::size_t>(guess)]).id == child.parent;
    const auto found = is_hit ? order_.begin() + guess
                              : std::lower_bound(order_.begin(), order_.end(), child.parent,
                                                 [this](std::int32_t i, std::int64_t id) { return node(i).id < id; });
    const bool is_there = found != order_.end() && node(*found).id == child.parent;
    if (is_there && &node(*found) != &child) return *found;
    problems_.complain(child.parent_place,
                       is_there ? fmt::format("the node {} is its own parent", child.id)
                                : fmt::format("there is no node {}, the parent of node {}", child.parent, child.id),
                       "a root has the parent -1");
    return -1;
  }

  // Follows parents from every node; meeting the path again is a circle.
  void refuse_circles() {
    enum class State : std::uint8_t { New, OnPath, Done };
    std::vector<State> states(nodes_.size(), State::New);
    const auto state = [&](std::int32_t i) -> State& { return states[static_cast<std::size_t>(i)]; };
    std::vector<std::int32_t> path;
    for (std::size_t start = 0; start < nodes_.size(); ++start) {
      std::int32_t at = static_cast<std::int32_t>(start);
      for (; at >= 0 && state(at) == State::New; at = parents_[static_cast<std::size_t>(at)]) {
        state(at) = State::OnPath;
        path.push_back(at);
      }
      if (at >= 0 && state(at) == State::OnPath)
        problems_.complain(node(at).parent_place, fmt::format("the node {} is its own ancestor", node(at).id),
                           "parents must lead to a root, whose parent is -1");
      for (const std::int32_t i : path) state(i) = State::Done;
      path.clear();
    }
  }

  const std::vector<NamedNode>& nodes_;
  FileProblems& problems_;
  std::vector<std::int32_t> order_, parents_;
};

}  // namespace

std::vector<std::int32_t> parent_indices(const std::vector<NamedNode>& nodes, FileProblems& problems) {
  return Linker(nodes, problems).link();
}

}  // namespace marrow
