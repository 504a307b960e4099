// Two passes: lines to nodes with std::from_chars, then parents from ids to indices.
#include "renderer/scene/files/swc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/core.h>

namespace marrow {
namespace {

struct Node {
  std::int64_t id, parent;
  std::int32_t line;
};

class SwcReader {
 public:
  SwcReader(const SwcOptions& options, const std::string& name) : options_(options), name_(name) {}

  Result<SwcSkeleton> read(std::string_view text) {
    reserve(text);
    std::int32_t line = 1;
    for (; !text.empty() && !is_full(); ++line) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      read_line(text.substr(0, end), line);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (nodes_.empty() && problems_.empty())
      complain(0, 0, "the file has no nodes", "a line is: id type x y z radius parent");
    if (problems_.empty()) link();
    if (problems_.empty()) refuse_circles();
    if (problems_.empty()) repair_radii();
    if (!problems_.empty()) return std::move(problems_);
    return SwcSkeleton{std::move(graph_), std::move(warnings_)};
  }

 private:
  static constexpr std::size_t max_problems = 20;
  enum Column { Id, Type, X, Y, Z, Radius, Parent, Columns };

  bool is_full() const { return problems_.size() >= max_problems; }

  void complain(int line, int column, std::string message, std::string hint = {}) {
    if (is_full()) return;
    problems_.push_back({.where = {.file = name_, .line = line, .column = column},
                         .message = std::move(message),
                         .hint = std::move(hint)});
  }

  void reserve(std::string_view text) {
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
    nodes_.reserve(lines);
    graph_.positions.reserve(lines);
    graph_.radii.reserve(lines);
  }

  void read_line(std::string_view line, std::int32_t number) {
    line = line.substr(0, line.find('#'));
    std::array<double, Columns> value{};
    const char *at = line.data(), *const end = at + line.size();
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    int column = 0;
    for (; column < Columns; ++column) {
      while (at != end && is_blank(*at)) ++at;
      if (at == end) break;
      const int place = static_cast<int>(at - line.data()) + 1;
      const char* stop = std::find_if(at, end, is_blank);
      if (!read_number(at, stop, value[static_cast<std::size_t>(column)]))
        return complain(number, place, fmt::format("`{}` is not a finite number", std::string_view(at, stop)),
                        "a line is: id type x y z radius parent");
      at = stop;
    }
    if (column == 0) return;
    if (column < Columns)
      return complain(number, 1, fmt::format("the line has {} columns, it needs 7", column),
                      "a line is: id type x y z radius parent");
    add(value, number);
  }

  static bool read_number(const char* at, const char* stop, double& value) {
    if (at != stop && *at == '+') ++at;
    const auto [end, error] = std::from_chars(at, stop, value);
    return error == std::errc{} && end == stop && std::isfinite(value);
  }

  void add(const std::array<double, Columns>& value, std::int32_t line) {
    constexpr double exact = 9007199254740992.0;  // 2^53: whole numbers up to here have a double
    for (const Column c : {Id, Type, Parent})
      if (std::floor(value[c]) != value[c] || std::fabs(value[c]) > exact)
        return complain(line, 1,
                        fmt::format("the {} is not a whole number", c == Id     ? "id"
                                                                    : c == Type ? "type"
                                                                                : "parent"));
    if (value[Radius] < 0) return complain(line, 1, "the radius is negative");
    nodes_.push_back({static_cast<std::int64_t>(value[Id]), static_cast<std::int64_t>(value[Parent]), line});
    graph_.positions.push_back(Vec3d{value[X], value[Y], value[Z]} * options_.scale);
    graph_.radii.push_back(value[Radius] * options_.scale);
    constexpr double largest = 1e15;  // as every coordinate of a scene
    if (!(max_component(abs(graph_.positions.back())) <= largest) || !(graph_.radii.back() <= largest))
      complain(line, 1, "the node lies beyond 1e15 scene units");
  }

  // Node indices in the order of their ids. Files are nearly always sorted already.
  std::vector<std::int32_t> order_by_id() {
    std::vector<std::int32_t> order(nodes_.size());
    std::iota(order.begin(), order.end(), 0);
    const auto less = [this](std::int32_t a, std::int32_t b) { return node(a).id < node(b).id; };
    if (!std::is_sorted(order.begin(), order.end(), less)) std::stable_sort(order.begin(), order.end(), less);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (node(order[i]).id == node(order[i - 1]).id)
        complain(node(order[i]).line, 1, fmt::format("the id {} is given twice", node(order[i]).id),
                 fmt::format("it stands first in line {}", node(order[i - 1]).line));
    return order;
  }

  const Node& node(std::int32_t index) const { return nodes_[static_cast<std::size_t>(index)]; }

  void link() {
    const std::vector<std::int32_t> order = order_by_id();
    if (!problems_.empty()) return;
    const std::int64_t first = node(order.front()).id;
    graph_.parents.reserve(nodes_.size());
    for (const Node& child : nodes_) {
      if (child.parent < 0 && child.parent != child.id) {
        graph_.parents.push_back(SkeletonGraph::no_parent);
        continue;
      }
      // Where ids count up by one, the place is known; else search.
      const std::int64_t guess = child.parent - first;
      const bool is_hit = guess >= 0 && guess < static_cast<std::int64_t>(order.size()) &&
                          node(order[static_cast<std::size_t>(guess)]).id == child.parent;
      const auto found = is_hit ? order.begin() + guess
                                : std::lower_bound(order.begin(), order.end(), child.parent,
                                                   [this](std::int32_t i, std::int64_t id) { return node(i).id < id; });
      if (child.parent == child.id)
        complain(child.line, 1, fmt::format("the node {} is its own parent", child.id), "a root has the parent -1");
      else if (found == order.end() || node(*found).id != child.parent)
        complain(child.line, 1, fmt::format("there is no node {}, the parent of node {}", child.parent, child.id),
                 "a root has the parent -1");
      else graph_.parents.push_back(*found);
    }
  }

  // Follows parents from every node; meeting the path again is a circle.
  void refuse_circles() {
    enum class State : std::uint8_t { New, OnPath, Done };
    std::vector<State> states(nodes_.size(), State::New);
    const auto state = [&](std::int32_t i) -> State& { return states[static_cast<std::size_t>(i)]; };
    std::vector<std::int32_t> path;
    for (std::size_t start = 0; start < nodes_.size(); ++start) {
      std::int32_t at = static_cast<std::int32_t>(start);
      for (; at >= 0 && state(at) == State::New; at = graph_.parents[static_cast<std::size_t>(at)]) {
        state(at) = State::OnPath;
        path.push_back(at);
      }
      if (at >= 0 && state(at) == State::OnPath)
        complain(node(at).line, 1, fmt::format("the node {} is its own ancestor", node(at).id),
                 "parents must lead to a root, whose parent is -1");
      for (const std::int32_t i : path) state(i) = State::Done;
      path.clear();
    }
  }

  void repair_radii() {
    const auto zeros = std::count(graph_.radii.begin(), graph_.radii.end(), 0.0);
    double floor = options_.min_radius.value_or(0);
    if (zeros > 0 && !options_.min_radius) {
      floor = std::numeric_limits<double>::infinity();
      for (const double r : graph_.radii)
        if (r > 0) floor = std::min(floor, r);
      if (std::isinf(floor)) return complain(0, 0, "every radius of the file is 0", "give the skeleton a `min_radius`");
      Diagnostic warning = failure(
          fmt::format(
              "{} of {} nodes have the radius 0; they get the smallest other radius of the file, {} scene units", zeros,
              nodes_.size(), floor),
          name_);
      warning.hint = "choose it with `min_radius`";
      warning.severity = Severity::Warning;
      warnings_.push_back(std::move(warning));
    }
    for (double& r : graph_.radii) r = std::max(r, floor);
  }

  const SwcOptions& options_;
  const std::string& name_;
  std::vector<Node> nodes_;
  SkeletonGraph graph_;
  Diagnostics problems_, warnings_;
};

}  // namespace

Result<SwcSkeleton> read_swc(std::string_view text, const SwcOptions& options, const std::string& name) {
  return SwcReader(options, name).read(text);
}

}  // namespace marrow
