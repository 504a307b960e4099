// Nodes of any kind with random parameters, drawn by their own keys().
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "field/tree/tree_node.h"
#include "tests/field/random.h"

namespace marrow::test {

/// Called by keys() with each parameter; draws within its limits, in sizes that fit a scene of some units.
template <class Kind>
class RandomParameters {
 public:
  RandomParameters(Kind& node, std::size_t children, Random& random)
      : node_(node), children_(children), random_(random) {}

  template <class T, class Form>
  void operator()(const char*, T Kind::*member, const Form& form, const char*) const {
    draw(node_.*member, form);
  }

 private:
  double real(double min, double max, bool min_open) const {
    const double end = random_.between(0, 10);
    if (end < 0.5 && !min_open && min > -form::largest) return min;
    if (end > 9.5 && max - min <= 4) return max;
    if (max - min <= 4) return max - (max - min) * random_.between(0, 1);
    if (min >= 0) return std::min(max, min + pow(10.0, random_.between(-1.2, 0.5)));
    return random_.between(std::max(min, -2.0), std::min(max, 2.0));
  }
  bool maybe() const { return random_.between(0, 1) < 0.5; }

  void draw(double& x, const form::Real& f) const { x = real(f.min, f.max, f.min_open); }
  void draw(double& x, const form::Angle& f) const {
    constexpr double degree = 0.017453292519943295;
    x = degree * random_.between(std::max(f.min_deg, -200.0), std::min(f.max_deg, 200.0));
  }
  void draw(int& x, const form::Whole& f) const { x = random_.whole(f.min, std::min(f.max, f.min + 8)); }
  void draw(bool& x, const form::Switch&) const { x = maybe(); }
  void draw(Vec3d& x, const form::Position&) const { x = random_.vector(1.5); }
  void draw(Vec3d& x, const form::Sizes&) const {
    for (std::size_t i = 0; i < 3; ++i) x[i] = random_.between(0.2, 2);
  }
  // An axis of coordinates now and then.
  void draw(UnitVec3& x, const form::Direction&) const {
    Vec3d v = random_.vector(1);
    if (random_.between(0, 1) < 0.2) {
      v = {};
      v[static_cast<std::size_t>(random_.whole(0, 2))] = maybe() ? 1 : -1;
    }
    x = normalize(v);
  }
  // In one plane at times, with dents and round a centre.
  void draw(std::vector<Vec3d>& x, const form::Points& f) const {
    x.assign(f.min_count + static_cast<std::size_t>(random_.whole(0, 4)), {});
    const bool flat = random_.between(0, 1) < 0.8;
    const Frame frame = Frame::around(normalize(random_.vector(1)));
    const Vec3d center = random_.vector(0.5);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double angle = 6.283 * (static_cast<double>(i) + random_.between(0, 0.9)) / static_cast<double>(x.size());
      const double r = random_.between(0.3, 1.5);
      x[i] = flat ? center + frame.to_world({r * cos(angle), r * sin(angle), 0}) : random_.vector(1.5);
    }
  }
  void draw(std::vector<double>& x, const form::Reals& f) const {
    const int shape = random_.whole(0, 2);
    x.assign(shape == 0 ? 1 : shape == 1 ? 2 : std::max<std::size_t>(children_, 1), 0);
    for (double& one : x) one = real(f.min, f.max, f.min_open);
  }
  // Left out, a matrix over the children, or pairs of their numbers.
  void draw(std::vector<std::vector<double>>& x, const form::Rows& f) const {
    const int shape = random_.whole(0, 2);
    x.assign(shape == 0 ? 0 : children_, std::vector<double>(shape == 1 ? children_ : 2));
    for (auto& row : x)
      for (double& one : row)
        one = shape == 1 ? real(f.min, f.max, false) : random_.whole(0, static_cast<int>(children_) - 1);
  }
  template <class Enum>
  void draw(Enum& x, const form::Word&) const {
    const auto words = words_of(Enum{});
    x = std::next(std::begin(words), random_.whole(0, static_cast<int>(std::size(words)) - 1))->second;
  }
  template <class... Choices>
  void draw(std::variant<Choices...>& x, const form::OneOf&) const {
    int chosen = random_.whole(0, sizeof...(Choices) - 1);
    ((chosen-- == 0 ? choose<Choices>(x) : void()), ...);
  }
  template <class Choice, class Variant>
  void choose(Variant& x) const {
    Choice choice;
    Choice::keys(RandomParameters<Choice>(choice, children_, random_));
    x = choice;
  }

  Kind& node_;
  std::size_t children_;
  Random& random_;
};

/// What a kind tells about itself; compile() makes placements and unions without it.
template <class Kind>
constexpr NodeInfo info_of_kind() {
  if constexpr (std::same_as<Kind, AffineWarp>) return {"placement", {}, 1, 1};
  else if constexpr (std::same_as<Kind, CrispUnion>) return {"union", {}, 1, any_number_of_children};
  else if constexpr (std::same_as<Kind, PointLeaf>) return {"lone point", {}, 0, 0};
  else return Kind::info;
}

/// A turn, a stretch or a squeeze, a shear, at times a reflection, and a shift.
inline AffineWarp random_placement(Random& random) {
  Affine linear = Affine::rotate(normalize(random.vector(1)), random.between(-3, 3));
  Vec3d scale{};
  for (std::size_t i = 0; i < 3; ++i) scale[i] = pow(2.0, random.between(-1.5, 1.5));
  if (random.between(0, 1) < 0.2) scale.x = -scale.x;
  Affine shear;
  shear.columns[1].x = random.between(-1, 1);
  const Affine parent_from_child = Affine::translate(random.vector(1)) * shear * linear * Affine::scale(scale);
  return {parent_from_child, parent_from_child.inverse()};
}

/// One that its problem() accepts.
template <class Kind>
Kind random_node(std::size_t children, Random& random) {
  if constexpr (std::same_as<Kind, AffineWarp>) return random_placement(random);
  if constexpr (std::same_as<Kind, CrispUnion>) return {};
  if constexpr (std::same_as<Kind, PointLeaf>) return {random.vector(1), random.between(0.1, 1)};
  for (int trial = 0; trial < 1000; ++trial) {
    Kind node;
    if constexpr (requires { Kind::info; }) Kind::keys(RandomParameters<Kind>(node, children, random));
    if constexpr (requires { node.problem(children); })
      if (!node.problem(children).empty()) continue;
    return node;
  }
  throw std::runtime_error("no random parameters fit " + std::string(info_of_kind<Kind>().name));
}

}  // namespace marrow::test
