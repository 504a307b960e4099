#include "field/trace/sources/source_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "field/math/elementary.h"
#include "field/trace/sources/quadrature.h"

namespace marrow {
namespace {

// What is sorted instead of the pieces, which are large.
struct Item {
  Vec3d middle;
  std::uint32_t piece;
};

std::uint32_t node_count(std::size_t pieces) {
  if (pieces <= SourceTree::leaf_size) return 1;
  return 1 + node_count(pieces / 2) + node_count(pieces - pieces / 2);
}

std::size_t longest_axis(std::span<const Item> items) {
  Box3 box;
  for (const Item& i : items) box.include(i.middle);
  const Vec3d size = box.size();
  std::size_t axis = size.x >= size.y ? 0 : 1;
  return size[axis] >= size.z ? axis : 2;
}

// The sums of one piece about its middle.
struct Moments0 {
  double mass = 0, tau_mass = 0;
  Vec3d first, tau_first;
};

// Adds what a piece contributes to the sums of its node; `center` may be any point near.
class NodeSums {
 public:
  NodeSums(const Vec3d& origin, int degree) : origin_(origin), degree_(degree) {}

  void add(const Piece& p) {
    if (p.is_point()) {
      add(p.from, p.mass, p.radius);
      return;
    }
    // w tau |q|^2 is a polynomial of degree n + 2 <= 22 along the piece, n + 3 of one that leans; m nodes are exact up
    // to 2 m - 1.
    const int nodes = degree_ / 2 + (p.lean == 0 ? 2 : 3);
    const GaussNodes rule = gauss_legendre(std::min(nodes, max_gauss_nodes));
    const double unit = p.mass / integer_power(p.radius, degree_ - 1);
    for (std::size_t k = 0; k < rule.positions.size(); ++k) {
      const double s = rule.positions[k], tau = p.radius_from + (p.radius_to - p.radius_from) * s;
      add(lerp(p.from, p.to, s), rule.weights[k] * unit * integer_power(tau, degree_ - 1) * p.weight_at(s), tau);
    }
  }
  void add(const SourceNode& n) {
    const Vec3d at = n.center - origin_;
    mass_ += n.mass;
    first_ += at * n.mass;
    second_ += n.spread + n.mass * length_squared(at);
    tau_mass_ += n.tau_mass;
    tau_first_ += n.tau_shift + at * n.tau_mass;
    tau_second_ += n.tau_spread + 2 * dot(n.tau_shift, at) + n.tau_mass * length_squared(at);
  }
  // Moves the sums to the centre of mass.
  void write(SourceNode& n) const {
    const Vec3d c = mass_ > 0 ? first_ / mass_ : Vec3d{};
    n.center = origin_ + c;
    n.mass = mass_;
    n.tau_mass = tau_mass_;
    n.spread = std::max(0.0, second_ - mass_ * length_squared(c));
    n.tau_shift = tau_first_ - c * tau_mass_;
    n.tau_spread = std::max(0.0, tau_second_ - 2 * dot(tau_first_, c) + tau_mass_ * length_squared(c));
  }

 private:
  void add(const Vec3d& q, double w, double tau) {
    const Vec3d at = q - origin_;
    mass_ += w;
    first_ += at * w;
    second_ += w * length_squared(at);
    tau_mass_ += w * tau;
    tau_first_ += at * (w * tau);
    tau_second_ += w * tau * length_squared(at);
  }

  Vec3d origin_;
  int degree_;
  double mass_ = 0, second_ = 0, tau_mass_ = 0, tau_second_ = 0;
  Vec3d first_, tau_first_;
};

class Grower {
 public:
  Grower(std::span<const Piece> pieces, std::vector<Item>& items, std::vector<SourceNode>& nodes, int degree)
      : pieces_(pieces), items_(items), nodes_(nodes), degree_(degree) {}

  // Returns the bounds of what the node holds.
  Box3 grow(std::uint32_t index, std::size_t begin, std::size_t end) {
    SourceNode& node = nodes_[index];
    node.begin = static_cast<std::uint32_t>(begin);
    node.end = static_cast<std::uint32_t>(end);
    node.is_point = pieces_[items_[begin].piece].is_point();
    node.exponent = static_cast<std::uint16_t>(node.is_point ? degree_ - 1 : degree_);
    return end - begin <= SourceTree::leaf_size ? fill_leaf(node) : divide(node, index);
  }

 private:
  Box3 fill_leaf(SourceNode& node) const {
    Box3 box;
    NodeSums sums(items_[node.begin].middle, degree_);
    for (std::size_t i = node.begin; i < node.end; ++i) {
      box.include(pieces_[items_[i].piece].box());
      sums.add(pieces_[items_[i].piece]);
    }
    sums.write(node);
    node.thinnest = std::numeric_limits<double>::infinity();
    for (std::size_t i = node.begin; i < node.end; ++i) {
      const Piece& p = pieces_[items_[i].piece];
      node.thinnest = std::min(node.thinnest, p.radius);
      node.radius = std::max({node.radius, length(p.from - node.center), length(p.to - node.center)});
    }
    return box;
  }

  Box3 divide(SourceNode& node, std::uint32_t index) {
    const std::size_t begin = node.begin, end = node.end, middle = begin + (end - begin) / 2;
    const std::size_t axis = longest_axis(std::span(items_).subspan(begin, end - begin));
    const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
      return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.piece < b.piece;
    });
    node.right = index + 1 + node_count(middle - begin);
    Box3 left_box, right_box;
    const auto left = [&] { left_box = grow(index + 1, begin, middle); };
    const auto right = [&] { right_box = grow(node.right, middle, end); };
    if (end - begin > 4096) {
      tbb::parallel_invoke(left, right);
    } else {
      left();
      right();
    }
    join(node, nodes_[index + 1], nodes_[node.right]);
    left_box.include(right_box);
    node.radius = std::min(node.radius, farthest(left_box, node.center));
    return left_box;
  }

  void join(SourceNode& node, const SourceNode& a, const SourceNode& b) const {
    node.thinnest = std::min(a.thinnest, b.thinnest);
    NodeSums sums(a.center, degree_);
    sums.add(a);
    sums.add(b);
    sums.write(node);
    node.radius = std::max(a.radius + length(a.center - node.center), b.radius + length(b.center - node.center));
  }

  static double farthest(const Box3& box, const Vec3d& p) {
    const Vec3d a = abs(box.lower - p), b = abs(box.upper - p);
    return length({std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)});
  }

  std::span<const Piece> pieces_;
  std::vector<Item>& items_;
  std::vector<SourceNode>& nodes_;
  int degree_;
};

}  // namespace

SourceTree::SourceTree(std::vector<Piece> pieces, int degree) {
  std::vector<Item> items(pieces.size());
  for (std::size_t i = 0; i < items.size(); ++i) items[i] = {pieces[i].middle(), static_cast<std::uint32_t>(i)};
  // Curves, then points, as pieces come; a node holds one kind.
  const auto first_point = static_cast<std::size_t>(
      std::find_if(pieces.begin(), pieces.end(), [](const Piece& p) { return p.is_point(); }) - pieces.begin());
  const std::size_t ends[] = {first_point, pieces.size()};
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    if (end > begin) {
      const auto root = static_cast<std::uint32_t>(nodes_.size());
      nodes_.resize(nodes_.size() + node_count(end - begin));
      Grower(pieces, items, nodes_, degree).grow(root, begin, end);
      roots_.push_back(SourceRef::node(root));
    }
    begin = end;
  }
  pieces_.resize(pieces.size());
  tbb::parallel_for(std::size_t{0}, items.size(), [&](std::size_t i) { pieces_[i] = pieces[items[i].piece]; });
}

}  // namespace marrow
