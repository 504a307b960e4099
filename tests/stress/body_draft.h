// What trees of bodies are put together from, for scenes of the stress tests.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "tests/stress/drawing.h"
#include "tests/stress/tree_drafts.h"
#include "tests/trace/random_scene.h"
#include "tests/tree/random_tree.h"

namespace marrow::test {

using Records = std::vector<std::uint32_t>;

inline bool maybe(Random& random, double share = 0.5) { return random.between(0, 1) < share; }
inline double sign(Random& random) { return maybe(random) ? 1 : -1; }

// None, a rounding, or up to a tenth, to either side.
inline double gap(Random& random) { return maybe(random, 0.3) ? 0 : sign(random) * power_of_ten(random, -14, -1); }

inline Potential potential(Random& random, double range) {
  switch (random.whole(0, 3)) {
    case 0:
      return PolynomialProfile{range, random.whole(2, 6)};
    case 1:
      return SoftObjectProfile{range};
    case 2:
      return MetaballProfile{range};
    default:
      return WyvillProfile{range};
  }
}
inline Potential potential(Random& random) { return potential(random, power_of_ten(random, -1.5, 0.3)); }

// What a kind of scene draws: bodies that stand beside each other.
class BodyDraft {
 public:
  explicit BodyDraft(Random& random) : random_(random), trees_(random) {}

  std::uint32_t leaf(TreeNode node) { return trees_.leaf(std::move(node)); }
  std::uint32_t of(TreeNode node, const Records& children) { return trees_.record(std::move(node), children); }
  std::uint32_t any(int levels) { return trees_.add(levels); }
  /// One of these kinds of operators, drawn by its own keys.
  template <class... Kinds>
  std::uint32_t one_of(const Records& children) {
    int chosen = random_.whole(0, sizeof...(Kinds) - 1);
    std::uint32_t made = 0;
    ((chosen-- == 0 ? void(made = of(random_node<Kinds>(children.size(), random_), children)) : void()), ...);
    return made;
  }
  std::uint32_t combined(const Records& children) {
    return one_of<Intersection, Difference, SoftUnion, SoftIntersection, SoftDifference, SharpUnion, SharpIntersection,
                  SharpDifference, CrispUnion, Sum, Ricci, Contact, WeightedBlend, RestrictedBlend>(children);
  }
  std::uint32_t blended(const Records& children) {
    return one_of<Sum, Ricci, SoftUnion, SharpUnion, CrispUnion, Contact, WeightedBlend, RestrictedBlend>(children);
  }
  std::uint32_t placed(const Affine& place, std::uint32_t child) {
    return of(AffineWarp{place, place.inverse()}, {child});
  }

  Records bodies;
  std::vector<Vec3d> places;
  double focus_size = 0.1;

  TreeDraft finished(const Affine& place) {
    const std::uint32_t root = placed_bodies(place);
    // What has no end is cut.
    if (const Box3 box = surface_bounds(trees_.tree()); !(is_finite(box.lower) && is_finite(box.upper))) {
      const std::uint32_t end = leaf(Sphere{.center = {}, .radius = 2.5, .potential = {}});
      of(Intersection{}, {root, placed(place, end)});
    }
    TreeDraft draft{trees_.tree(), std::move(places), focus_size};
    for (Vec3d& p : draft.places) p = place.point(p);
    return draft;
  }

 private:
  // Each by itself or all together, as one node or as members of a union.
  std::uint32_t placed_bodies(const Affine& place) {
    if (place == Affine{}) return bodies.size() == 1 ? bodies[0] : of(CrispUnion{}, bodies);
    if (bodies.size() == 1 || maybe(random_))
      return placed(place, bodies.size() == 1 ? bodies[0] : of(CrispUnion{}, bodies));
    for (std::uint32_t& b : bodies) b = placed(place, b);
    return of(CrispUnion{}, bodies);
  }

  Random& random_;
  RandomTree trees_;
};

inline std::uint32_t box(BodyDraft& d, Random& random, const Vec3d& center, const Vec3d& size) {
  return d.leaf(Box{.center = center, .size = size, .rounding = 0, .potential = potential(random)});
}
inline std::uint32_t ball(BodyDraft& d, Random& random, const Vec3d& center, double radius) {
  return d.leaf(Sphere{.center = center, .radius = radius, .potential = potential(random)});
}
inline std::uint32_t tube(BodyDraft& d, Random& random, const Vec3d& from, const Vec3d& to, double radius) {
  return d.leaf(Cylinder{.from = from, .to = to, .radius = radius, .potential = potential(random)});
}
inline std::uint32_t some_body(BodyDraft& d, Random& random) {
  switch (random.whole(0, 4)) {
    case 0:
      return box(d, random, random.vector(0.3), {0.6, 2, 0.6});
    case 1:
      return tube(d, random, {0, -1.2, 0}, {0, 1.2, 0}, random.between(0.05, 0.5));
    case 2:
      return d.leaf(random_node<Torus>(0, random));
    case 3: {
      const Setting setting{.degree = random.whole(3, 6), .alpha = random.between(-1, 1.5)};
      return d.leaf(BlendLeaf{std::make_shared<const BlendField>(random_scene(random, setting, 2))});
    }
    default:
      return d.any(0);
  }
}

}  // namespace marrow::test
