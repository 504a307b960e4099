// General trees as nobody would model them.
#include "tests/stress/odd_tree_drafts.h"

#include <array>
#include <memory>
#include <numbers>
#include <utility>

#include "field/blend/angle/contact.h"
#include "tests/stress/drawing.h"
#include "tests/stress/odd_drafts.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

// 0 more often than not, or as little as a double or a float tells, or more.
double hardly_any(Random& random) { return maybe(random) ? 0 : sign(random) * power_of_ten(random, -16, -3); }

std::uint32_t leaf_of(BodyDraft& d, BlendField blend) {
  return d.leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(blend))});
}

// One ball or tube by the formulas of several nodes.
std::uint32_t same_body(BodyDraft& d, Random& random, bool tube_like, double radius) {
  const Potential p = potential(random);
  const Vec3d from{-0.7, 0, 0}, to{0.7, 0, 0};
  if (tube_like) {
    switch (random.whole(0, 3)) {
      case 0:
        return d.leaf(Cylinder{.from = from, .to = to, .radius = radius, .potential = p});
      case 1:
        return d.leaf(Cone{.from = from, .to = to, .radius = {radius, radius}, .potential = p});
      case 2:
        return d.leaf(LineSolid{.from = from, .to = to, .radius = {radius}, .potential = p});
      default:
        return d.leaf(Box{.center = {}, .size = {1.4, 2 * radius, 2 * radius}, .rounding = 0, .potential = p});
    }
  }
  switch (random.whole(0, 3)) {
    case 0:
      return d.leaf(Sphere{.center = {}, .radius = radius, .potential = p});
    case 1:
      return d.leaf(Ellipsoid{.center = {}, .radii = Vec3d{1, 1, 1} * radius, .potential = p});
    case 2:
      return d.leaf(Torus{.center = {}, .radius = radius / 2, .tube = radius / 2, .potential = p});
    default: {
      BlendField blend;
      blend.points.add({{0, 0, 0}, radius}, {});
      return leaf_of(d, std::move(blend));
    }
  }
}

// Bodies with the same surface, or nearly the same, taken from each other, joined, or what is in both.
void coincident(BodyDraft& d, Random& random) {
  const bool tube_like = maybe(random);
  const auto body = [&] { return same_body(d, random, tube_like, 0.5 + hardly_any(random)); };
  std::uint32_t one = body();
  for (int i = random.whole(1, 3); i > 0; --i)
    one = maybe(random) ? d.combined({one, body()}) : d.one_of<Intersection, Difference>({one, body()});
  if (maybe(random, 0.3)) one = d.combined({one, d.any(0)});
  d.places = {{0.5, 0, 0}, {0, 0.5, 0}, {0.7, 0.5, 0}, {0.7, 0.5, 0.5}, {}};
  d.bodies = {one};
}

// Thin bodies near the axes of warps whose amounts are out of all proportion.
void cusps(BodyDraft& d, Random& random) {
  std::uint32_t one = 0;
  switch (random.whole(0, 3)) {
    case 0:
      one = box(d, random, random.vector(0.2), {power_of_ten(random, -3, 0), 2, 1});
      break;
    case 1:
      one = tube(d, random, {-1, -0.5, 0}, {1, 0.5, 0}, power_of_ten(random, -3, -0.5));
      break;
    case 2:
      one = leaf_of(d, random_scene(random, {.degree = random.whole(3, 6), .alpha = contact_alpha(4)}, 3));
      break;
    default:
      one = d.any(1);
  }
  d.places = {{}, {0, 0.5, 0}};
  for (int i = random.whole(1, 3); i > 0; --i) {
    switch (random.whole(0, 3)) {
      case 0:
        one = d.of(Twist{.center = {},
                         .axis = UnitVec3::unchecked({0, 1, 0}),
                         .angle_per_length = sign(random) * power_of_ten(random, 0.5, 2.5)},
                   {one});
        break;
      case 1: {
        const double length = power_of_ten(random, -4, 0.5);
        one = d.of(Taper{.center = {},
                         .axis = UnitVec3::unchecked({0, 1, 0}),
                         .length = length,
                         .start = power_of_ten(random, -3, 0.5),
                         .end = power_of_ten(random, -5, 1)},
                   {one});
        d.places.push_back({0, length, 0});
        break;
      }
      case 2: {
        const double length = power_of_ten(random, -3, 0.7);
        const double angle = maybe(random) ? 2 * std::numbers::pi : power_of_ten(random, -4, 0.79);
        one = d.of(Bend{.length = length, .angle = angle}, {one});
        d.places.push_back({length / angle, 0, 0});
        d.places.push_back({2 * length / angle, 0, 0});
        break;
      }
      default:
        one = d.of(Shear{.center = {},
                         .axis = UnitVec3::unchecked({0, 1, 0}),
                         .toward = UnitVec3::unchecked({1, 0, 0}),
                         .amount = sign(random) * power_of_ten(random, 0, 3)},
                   {one});
    }
  }
  d.bodies = {one};
}

Affine squeeze(Random& random) {
  Vec3d by;
  for (std::size_t i = 0; i < 3; ++i) by[i] = sign(random) * power_of_ten(random, -3, 0.3);
  const Affine turn =
      maybe(random, 0.3) ? Affine{} : Affine::rotate(normalize(random_direction(random)), random.between(-3, 3));
  return Affine::translate(random.vector(0.3)) * turn * Affine::scale(by);
}

// Maps that are far from similarities, within each other.
void squeezed(BodyDraft& d, Random& random) {
  Records of;
  for (int i = random.whole(1, 3); i > 0; --i) {
    std::uint32_t one = maybe(random, 0.6) ? d.any(0) : d.any(1);
    for (int k = random.whole(1, 2); k > 0; --k) one = d.placed(squeeze(random), one);
    of.push_back(one);
  }
  d.places = {{}, random.vector(0.3)};
  d.bodies = {of.size() == 1 ? of[0] : d.combined(of)};
  if (maybe(random, 0.3)) d.bodies = {d.placed(squeeze(random), d.bodies[0])};
}

// Bodies that press each other, some of them in one place, some hardly at all, pressed again by others.
void pressed(BodyDraft& d, Random& random) {
  Records of;
  double edge = 0;
  for (int i = random.whole(2, 5); i > 0; --i) {
    const double r = random.between(0.1, 0.5), at = edge + r + (maybe(random) ? -0.3 * r : hardly_any(random));
    const Vec3d center{at - 1, 0, 0};
    const int kind = random.whole(0, 2);
    if (kind == 0) of.push_back(ball(d, random, center, r));
    else if (kind == 1) of.push_back(box(d, random, center, Vec3d{2, 2, 2} * r));
    else of.push_back(tube(d, random, center - Vec3d{0, 0.6, 0}, center + Vec3d{0, 0.6, 0}, r));
    edge = at + r;
    d.places.push_back({edge - 1, 0, 0});
    d.places.push_back({edge - 1, r, 0});
  }
  std::uint32_t one = d.one_of<Contact>(of);
  if (maybe(random, 0.4)) one = d.one_of<Contact>({one, box(d, random, {0, -0.5, 0}, {3, 0.5, 1})});
  if (maybe(random, 0.3)) one = d.combined({one, d.any(0)});
  d.bodies = {one};
}

// Powers from 1 to 1000, over each other.
void powers(BodyDraft& d, Random& random) {
  const auto joined = [&](const Records& of) {
    const int kind = random.whole(0, 3);
    if (kind == 0) return d.of(Sum{}, of);
    if (kind == 1) return d.one_of<WeightedBlend, RestrictedBlend>(of);
    return d.of(Ricci{.power = maybe(random, 0.2) ? 1000 : power_of_ten(random, 0, 3)}, of);
  };
  const auto some = [&] {
    Records of;
    for (int i = random.whole(2, 6); i > 0; --i) {
      const Vec3d at = random.vector(0.7);
      d.places.push_back(at);
      of.push_back(maybe(random) ? ball(d, random, at, random.between(0.1, 0.5)) : d.any(0));
    }
    return joined(of);
  };
  std::uint32_t one = some();
  if (maybe(random)) one = joined({one, some()});
  d.bodies = {one};
}

// Flat bodies down to a millionth thick, beside each other by as little, or across.
void sheets(BodyDraft& d, Random& random) {
  const auto sheet = [&](double height, double thickness) {
    const Potential p = potential(random, maybe(random) ? thickness * power_of_ten(random, -1, 3) : 0.3);
    switch (random.whole(0, 3)) {
      case 0:
        return d.leaf(Box{.center = {0, height, 0}, .size = {1.5, thickness, 1}, .rounding = 0, .potential = p});
      case 1:
        return d.leaf(Disc{.center = {0, height, 0},
                           .axis = UnitVec3::unchecked({0, 1, 0}),
                           .radius = 0.7,
                           .thickness = thickness,
                           .potential = p});
      case 2: {
        const Polygon flat{
            .points = {{-0.7, height, -0.6}, {0.8, height, -0.5}, {0.6, height, 0.7}, {-0.2, height, 0.1}},
            .thickness = thickness,
            .potential = p};
        return d.leaf(flat);
      }
      default:
        return d.leaf(Cylinder{.from = {0, height - thickness / 2, 0},
                               .to = {0, height + thickness / 2, 0},
                               .radius = 0.7,
                               .potential = p});
    }
  };
  Records of;
  double height = 0;
  for (int i = random.whole(2, 5); i > 0; --i) {
    const double thickness = power_of_ten(random, -6, -1);
    height += thickness / 2;
    d.places.push_back({random.between(-0.5, 0.5), height, random.between(-0.5, 0.5)});
    d.places.push_back({0.7, height + thickness / 2, 0});
    of.push_back(sheet(height, thickness));
    height += thickness / 2 + (maybe(random, 0.3) ? 0 : power_of_ten(random, -9, -1));
  }
  d.focus_size = power_of_ten(random, -6, -1);
  if (maybe(random, 0.3)) of.push_back(ball(d, random, {0, 0, 0}, 0.4));
  if (maybe(random, 0.4)) d.bodies = of;
  else d.bodies = {d.combined(of)};
  if (maybe(random, 0.3))
    for (std::uint32_t& b : d.bodies)
      b = d.placed(Affine::rotate(normalize(Vec3d{1, 2, 3}), random.between(0.1, 3)), b);
}

// Those that the tracer of blends is tried with, under operators and warps.
void odd_blends(BodyDraft& d, Random& random) {
  constexpr std::size_t dust = 11;
  std::size_t kind = 0;
  do kind = static_cast<std::size_t>(random.whole(0, odd_kind_count - 1));
  while (kind == dust);
  BlendField blend = odd_blend(kind, random);
  for (std::size_t i = 0; i < blend.segments.size(); ++i) {
    d.places.push_back(blend.segments.skeletons[i].from);
    d.places.push_back(blend.segments.skeletons[i].to);
  }
  for (const PointSkeleton& p : blend.points.skeletons) d.places.push_back(p.at);
  std::uint32_t one = leaf_of(d, std::move(blend));
  if (maybe(random)) one = d.combined({one, d.any(0)});
  if (maybe(random, 0.3)) one = d.one_of<Twist, Taper, Bend, Shear>({one});
  d.bodies = {one};
}

// What many half spaces have in common, some nearly in one plane; wedges; the same softly.
void planes(BodyDraft& d, Random& random) {
  const int count = random.whole(4, 12);
  const bool soft = maybe(random, 0.3);
  Records of;
  Vec3d normal = random_direction(random);
  for (int i = 0; i < count; ++i) {
    if (maybe(random, 0.3)) normal = normalize(-normal + random_direction(random) * power_of_ten(random, -7, -1)).vec();
    else if (maybe(random, 0.3))
      normal = normalize(normal + random_direction(random) * power_of_ten(random, -7, -1)).vec();
    else if (maybe(random, 0.3)) normal = Vec3d{i % 3 == 0 ? 1.0 : 0, i % 3 == 1 ? -1.0 : 0, i % 3 == 2 ? 1.0 : 0};
    else normal = random_direction(random);
    const double away = maybe(random, 0.2) ? power_of_ten(random, -6, -1) : random.between(0.2, 0.8);
    of.push_back(d.leaf(Plane{.point = normal * away, .normal = normalize(normal), .potential = potential(random)}));
    d.places.push_back(normal * away);
  }
  of.push_back(ball(d, random, {}, 1));
  std::uint32_t one = soft ? d.one_of<SoftIntersection, SharpIntersection>(of) : d.of(Intersection{}, of);
  if (maybe(random, 0.3)) one = d.combined({one, d.any(0)});
  d.bodies = {one};
}

// Bodies in bodies, with walls down to a millionth, cut open or closed.
void shells(BodyDraft& d, Random& random) {
  double radius = 0.9;
  std::uint32_t one = ball(d, random, {}, radius);
  for (int i = random.whole(1, 4); i > 0; --i) {
    const double wall = maybe(random) ? power_of_ten(random, -7, -1) : power_of_ten(random, -3, -0.5);
    if (!(radius - wall > 0.05)) break;
    radius -= wall;
    d.places.push_back(random_direction(random) * (radius + wall / 2));
    one = d.of(Difference{}, {one, ball(d, random, {}, radius)});
    const double space = power_of_ten(random, -7, -1);
    if (!(radius - space > 0.05)) break;
    radius -= space;
    one = d.one_of<CrispUnion, SharpUnion, Ricci>({one, ball(d, random, {}, radius)});
  }
  if (maybe(random)) one = d.of(Difference{}, {one, box(d, random, {0.5, 0.5, 0}, {1, 1, 3})});
  if (maybe(random, 0.3)) one = d.placed(squeeze(random), one);
  d.places.push_back({});
  d.focus_size = power_of_ten(random, -5, -1);
  d.bodies = {one};
}

// Members of a union that are taken from, joined at faces, or inside each other, with threads through all.
void joined(BodyDraft& d, Random& random) {
  const double g = hardly_any(random);
  for (int i = random.whole(2, 6); i > 0; --i) {
    const double x = 0.5 * i - 1;
    const Vec3d center{x + (maybe(random) ? g : 0), 0, 0};
    d.places.push_back({x + 0.25, 0.25, 0});
    d.places.push_back({x + 0.25, random.between(-0.2, 0.2), random.between(-0.2, 0.2)});
    std::uint32_t one = maybe(random, 0.7)
                            ? box(d, random, center, {0.5, 0.5, 0.5})
                            : tube(d, random, center - Vec3d{0.25, 0, 0}, center + Vec3d{0.25, 0, 0}, 0.25);
    if (maybe(random, 0.3)) one = d.combined({one, ball(d, random, center, 0.25)});
    d.bodies.push_back(one);
  }
  if (maybe(random)) d.bodies.push_back(tube(d, random, {-2, 0, 0}, {2, 0, 0}, power_of_ten(random, -5, -0.6)));
  if (maybe(random, 0.3)) d.bodies.push_back(d.any(1));
  if (maybe(random, 0.2))
    d.bodies = {d.of(Difference{}, {box(d, random, {}, {3, 0.5, 0.4}), d.of(CrispUnion{}, d.bodies)})};
}

}  // namespace

void draw_odd_bodies(std::size_t kind, BodyDraft& d, Random& random) {
  using Draw = void (*)(BodyDraft&, Random&);
  constexpr std::array<Draw, odd_tree_kinds> draws{coincident, cusps,      squeezed, pressed, powers,
                                                   sheets,     odd_blends, planes,   shells,  joined};
  draws[kind](d, random);
}

}  // namespace marrow::test
