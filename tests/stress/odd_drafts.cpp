// Blends as nobody would model them.
#include "tests/stress/odd_drafts.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "field/blend/angle/contact.h"
#include "field/math/elementary.h"
#include "tests/stress/drawing.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

double either_side(Random& random) { return random.between(0, 1) < 0.5 ? -1 : 1; }

// On both sides of every angle at which something changes, to 1e-9.
double odd_angle(Random& random, const BlendField& blend) {
  const double contact = contact_alpha(blend.degree, blend.cavity, blend.projection), sum = std::numbers::pi / 2;
  // Without cavity small angles have no surface; below 0 there is only the paper's projection.
  const double least = blend.cavity ? 0 : 0.25;
  switch (random.whole(0, 9)) {
    case 0:
      return least;
    case 1:
      return least + 1e-9;
    case 2:
      return sum - 1e-9;
    case 3:
      return sum;
    case 4:
      return contact + either_side(random) * 1e-9;
    case 5:
      return contact + either_side(random) * power_of_ten(random, -6, -1.5);
    case 6:
      return random.between(contact, sum);
    case 7:
      return blend.cavity && blend.projection == Projection::Paper ? random.between(-0.9, 0) : contact;
    default:
      return random.between(least, sum);
  }
}

BlendField empty_blend(Random& random, int degree) {
  BlendField blend;
  blend.degree = degree;
  blend.cavity = random.between(0, 1) < 0.8;
  if (random.between(0, 1) < 0.2) blend.projection = Projection::Exact;
  blend.alpha = odd_angle(random, blend);
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
  BlendField blend = empty_blend(random, random.whole(9, 20));
  for (int i = 0; i < 5; ++i) {
    const Vec3d at = random.vector(1);
    blend.segments.add({at, at + random.vector(0.7), random.between(0.05, 0.4), random.between(0.001, 0.4)}, {});
  }
  return blend;
}

BlendField touching(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 8));
  blend.cavity = random.between(0, 1) < 0.3;
  blend.alpha = contact_alpha(blend.degree, blend.cavity, blend.projection) +
                either_side(random) * power_of_ten(random, -9, -1.5);
  const double radius = 0.4, half = radius * (1 + either_side(random) * power_of_ten(random, -6, -1.5));
  if (random.between(0, 1) < 0.3) {
    for (const double side : {-1, 1}) blend.points.add({{side * half, 0, 0}, radius}, {});
    return blend;
  }
  const double tilt = random.between(0, 1) < 0.5 ? 0 : random.between(0, 1);
  blend.segments.add({{-1.3, 0, -half}, {1.3, 0, -half}, radius, radius}, {});
  blend.segments.add({{-1.3, -tilt, half}, {1.3, tilt, half}, radius, radius}, {});
  return blend;
}

BlendField cones(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 10));
  for (int i = random.whole(1, 4); i > 0; --i) {
    const Vec3d at = random.vector(0.8);
    blend.segments.add({at, at + random_direction(random) * power_of_ten(random, -3, 0.2),
                        power_of_ten(random, -4, -0.3), power_of_ten(random, -4, -0.3)},
                       {});
  }
  return blend;
}

BlendField hair(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 8));
  const double radius = power_of_ten(random, -4, -2.5);
  for (int i = random.whole(1, 3); i > 0; --i)
    blend.segments.add({random.vector(0.9), random.vector(0.9), radius, radius * random.between(0.3, 1)}, {});
  if (random.between(0, 1) < 0.5) blend.segments.add({{-1, 0, 0}, {1, 0, 0}, 0.3, 0.2}, {});
  return blend;
}

BlendField stubs(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 12));
  for (int i = random.whole(1, 4); i > 0; --i) {
    const double radius = power_of_ten(random, -2, -0.5);
    const Vec3d at = random.vector(0.8);
    blend.segments.add({at, at + random_direction(random) * (radius * power_of_ten(random, -3, 0)), radius,
                        radius * (random.between(0, 1) < 0.5 ? 1 : power_of_ten(random, -3, 0))},
                       {});
  }
  return blend;
}

BlendField hollow(Random& random) {
  BlendField blend;
  blend.degree = random.whole(3, 8);
  blend.cavity = false;
  blend.alpha = random.between(0.2, 0.7);
  const double radius = random.between(0.15, 0.6);
  for (int i = random.whole(3, 16); i > 0; --i) {
    if (i % 3 == 2) blend.segments.add({random.vector(0.7), random.vector(0.7), radius, 0.5 * radius}, {});
    else blend.points.add({random.vector(0.7), radius * random.between(0.5, 1)}, {});
  }
  return blend;
}

BlendField dust(Random& random) {
  BlendField blend = empty_blend(random, random.whole(3, 8));
  for (int i = random.whole(30, 200); i > 0; --i)
    blend.points.add({random.vector(0.9), power_of_ten(random, -4, -2.3)}, {});
  if (random.between(0, 1) < 0.4) blend.points.add({{0, 0, 0}, 0.4}, {});
  return blend;
}

}  // namespace

BlendField odd_blend(std::size_t kind, Random& random) {
  using Draw = BlendField (*)(Random&);
  constexpr std::array<Draw, odd_kind_count> draws{star,     bundle, jumps, graph, lattice, high_degree,
                                                   touching, cones,  hair,  stubs, hollow,  dust};
  return draws[kind](random);
}

}  // namespace marrow::test
