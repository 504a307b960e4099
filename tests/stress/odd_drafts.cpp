// Blends as nobody would model them.
#include "tests/stress/odd_drafts.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "field/blend/contact.h"
#include "field/math/elementary.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

// On both sides of every angle at which something changes, to 1e-9.
double odd_angle(Random& random, int degree, bool cavity) {
  const double contact = contact_alpha(degree), sum = std::numbers::pi / 2;
  if (!cavity) return random.between(0.3, sum);
  switch (random.whole(0, 7)) {
    case 0:
      return 0;
    case 1:
      return 1e-9;
    case 2:
      return sum - 1e-9;
    case 3:
      return contact + 1e-9;
    case 4:
      return contact - 1e-9;
    case 5:
      return random.between(contact, sum);
    case 6:
      return random.between(-0.8, 0);
    default:
      return random.between(0, sum);
  }
}

BlendField empty_blend(Random& random, int degree) {
  BlendField blend;
  blend.degree = degree;
  blend.cavity = random.between(0, 1) < 0.85;
  blend.alpha = odd_angle(random, degree, blend.cavity);
  return blend;
}

BlendField star(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 7));
  const int count = random.whole(10, 40);
  const double radius = random.between(0.02, 0.1);
  for (int i = 0; i < count; ++i) {
    const Vec3d out = random_direction(random) * 1.2;
    const bool through = random.between(0, 1) < 0.5;
    blend.segments.add({through ? -out : Vec3d{}, out, radius, through ? radius : radius * random.between(0.1, 1)}, {});
  }
  return blend;
}

BlendField bundle(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 7));
  const int count = random.whole(2, 30);
  const Vec3d from{-1, 0.1, 0}, to{1, 0, 0.2};
  for (int i = 0; i < count; ++i)
    blend.segments.add({from + random.vector(1e-7), to + random.vector(1e-7), 0.1, 0.1}, {});
  for (int i = 0; i < count / 2; ++i) blend.points.add({{0.3, 0.3, 0.3}, 0.1}, {});
  blend.segments.add({{-1, 0.3, 0}, {1, 0.3, 0.1}, 0.1, 0.08}, {});
  return blend;
}

BlendField jumps(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 7));
  const auto radius = [&] { return 0.3 * pow(10, random.between(-3, 0)); };
  Vec3d at = random.vector(0.5);
  for (int i = 0; i < 8; ++i) {
    const Vec3d to = at + random_direction(random) * random.between(0.1, 0.6);
    const double thick = radius();
    blend.segments.add({at, to, thick, random.between(0, 1) < 0.5 ? thick : radius()}, {});
    at = to;
  }
  return blend;
}

BlendField graph(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 7));
  std::vector<PointSkeleton> nodes;
  for (int i = 0; i < 6; ++i) nodes.push_back({random.vector(1), random.between(0.03, 0.3)});
  for (int i = 0; i < 12; ++i) {
    const auto from = static_cast<std::size_t>(random.whole(0, 5)), step = static_cast<std::size_t>(random.whole(1, 5));
    const PointSkeleton &a = nodes[from], &b = nodes[(from + step) % nodes.size()];
    blend.segments.add({a.at, b.at, a.radius, b.radius}, {});
  }
  return blend;
}

BlendField lattice(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 7));
  const double radius = std::ldexp(1, -random.whole(2, 5));
  for (int i = 0; i < 27; ++i) {
    const Vec3d at = Vec3d{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0} * 0.5;
    if (random.between(0, 1) < 0.3) blend.points.add({at, radius}, {});
  }
  for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
    blend.segments.add({-axis, axis, radius, radius}, {});
  return blend;
}

BlendField high_degree(Random& random) {
  constexpr int degrees[] = {9, 12, 20};
  BlendField blend = empty_blend(random, degrees[random.whole(0, 2)]);
  for (int i = 0; i < 5; ++i) {
    const Vec3d at = random.vector(1);
    blend.segments.add({at, at + random.vector(0.7), random.between(0.05, 0.4), random.between(0.001, 0.4)}, {});
  }
  return blend;
}

}  // namespace

BlendField odd_blend(std::size_t kind, Random& random) {
  using Draw = BlendField (*)(Random&);
  constexpr std::array<Draw, odd_kind_count> draws{star, bundle, jumps, graph, lattice, high_degree};
  return draws[kind](random);
}

}  // namespace marrow::test
