// What scenes of general trees are drawn from.
#include "tests/stress/tree_drafts.h"

#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "tests/field/varied_blend.h"
#include "tests/stress/body_draft.h"
#include "tests/stress/odd_tree_drafts.h"
#include "tests/stress/strand_drafts.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

void any_nodes(BodyDraft& d, Random& random) {
  d.bodies = {d.any(random.whole(1, 3))};
  d.places = {random.vector(1), {}};
  d.focus_size = 0.5;
}

// Two bodies along the axes whose faces, edges or tangent planes meet, but for a gap.
Records touching(BodyDraft& d, Random& random) {
  const double g = gap(random);
  switch (random.whole(0, 7)) {
    case 0:  // face on face, and two faces each in one plane
      d.places = {{1, 0.5, 0.6}, {1, -0.5, -0.6}, {1, 0.25, 0.6}, {1, 0, 0}};
      return {box(d, random, {}, {2, 1, 1.2}), box(d, random, {1.5 + g, 0.25, 0}, {1, 1, 1.2})};
    case 1:  // balls
      d.places = {{0.6, 0, 0}};
      return {ball(d, random, {}, 0.6), ball(d, random, {1 + g, 0, 0}, 0.4)};
    case 2:  // a hole from face to face, or a lid on it
      d.places = {{0, 0.5, 0}, {0.4, 0.5, 0}, {0, -0.5, 0.4}};
      return {box(d, random, {}, {1, 1, 1}), tube(d, random, {0, -0.5, 0}, {0, 0.5 + g, 0}, 0.4)};
    case 3:  // a ball that meets all faces from within
      d.places = {{0.5, 0, 0}, {0, 0.5, 0}, {0.5, 0.5, 0.5}};
      return {box(d, random, {}, {1, 1, 1}), ball(d, random, {}, 0.5 + g)};
    case 4: {  // in a ring
      d.places = {{0.5, 0, 0}, {0, 0, 0.5}, {0, 0, -0.5}};
      const Torus ring{.center = {}, .radius = 0.8, .tube = 0.3, .potential = potential(random)};
      return {d.leaf(ring), tube(d, random, {0, -0.6, 0}, {0, 0.6, 0}, 0.5 + g)};
    }
    case 5: {  // a tip on a face
      d.places = {{0, 0.5, 0}, {0, 1, 0}};
      const Cone cone{.from = {0, 1.4, 0}, .to = {0, 0.5 + g, 0}, .radius = {0.5, 0}, .potential = potential(random)};
      return {box(d, random, {}, {1, 1, 1}), d.leaf(cone)};
    }
    case 6: {  // a shell
      const double thickness = pow(10, random.between(-5, -1));
      d.places = {{0.7, 0, 0}, {0, 0.7 - thickness, 0}};
      return {ball(d, random, {}, 0.7), ball(d, random, {}, 0.7 - thickness)};
    }
    default: {  // a plane that touches a ball
      d.places = {{0, 0.6, 0}, {0, -0.6, 0}};
      const Plane plane{.point = {0, sign(random) * 0.6 + g, 0}, .potential = potential(random)};
      return {ball(d, random, {}, 0.6), d.leaf(plane)};
    }
  }
}

void creases(BodyDraft& d, Random& random) {
  const Records pair = touching(d, random);
  std::uint32_t one = d.combined(pair);
  if (maybe(random)) one = d.combined({one, d.any(0)});
  if (maybe(random, 0.2)) d.bodies = pair;
  else d.bodies = {one};
}

// Cuts of bends, tips of tapers, many turns of twists, one in another.
std::uint32_t warped(BodyDraft& d, Random& random, std::uint32_t child) {
  switch (random.whole(0, 4)) {
    case 0: {
      const double length = random.between(0.5, 3), angle = random.between(0.5, 2 * std::numbers::pi);
      d.places.push_back({length / angle, 0, 0});      // the centre of its circle
      d.places.push_back({2 * length / angle, 0, 0});  // in the cut
      return d.of(Bend{.length = length, .angle = angle}, {child});
    }
    case 1: {
      const double end = maybe(random) ? pow(10, random.between(-4, 0)) : random.between(1, 3);
      d.places.push_back({0, 1, 0});
      return d.of(Taper{.length = random.between(0.3, 2), .start = 1, .end = end}, {child});
    }
    case 2:
      return d.of(Twist{.angle_per_length = sign(random) * pow(10, random.between(-1, 1.3))}, {child});
    case 3:
      return d.of(Shear{.amount = sign(random) * pow(10, random.between(-1, 1.3))}, {child});
    default:
      return d.one_of<Bend, Taper, Twist, Shear>({child});
  }
}

void warps(BodyDraft& d, Random& random) {
  std::uint32_t one = some_body(d, random);
  if (maybe(random, 0.3)) one = d.combined({one, some_body(d, random)});
  d.places = {{}};
  for (int i = random.whole(1, 3); i > 0; --i) one = warped(d, random, one);
  if (maybe(random, 0.3)) one = d.combined({one, some_body(d, random)});
  d.bodies = {one};
}

// Bodies of about a ten-thousandth of the scene.
std::uint32_t thread(BodyDraft& d, Random& random, const Vec3d& at, const Vec3d& to) {
  const double r = pow(10, random.between(-4.3, -3)), range = r * pow(10, random.between(-1, 3));
  const Potential p = potential(random, range);
  d.focus_size = 4 * r;
  switch (random.whole(0, 6)) {
    case 0:
      return d.leaf(Cylinder{.from = at, .to = to, .radius = r, .potential = p});
    case 1:
      return d.leaf(Cone{.from = at, .to = to, .radius = {r, 0}, .potential = p});
    case 2:
      return d.leaf(LineSolid{.from = at, .to = to, .radius = {r}, .potential = p});
    case 3:
      return d.leaf(Disc{.center = at, .axis = normalize(to - at), .radius = 0.3, .thickness = r, .potential = p});
    case 4:
      return d.leaf(Torus{.center = at, .axis = normalize(to - at), .radius = 0.3, .tube = r, .potential = p});
    case 5:
      return d.leaf(ConvolutionSegment{at, to, {r}});
    default:
      return d.leaf(Sphere{.center = at, .radius = r, .potential = p});
  }
}

// In a body, beside it, through it.
void threads(BodyDraft& d, Random& random) {
  const Vec3d at = random_direction(random) * random.between(0.4, 0.9), to = at + random.vector(1);
  const std::uint32_t thin = thread(d, random, at, to);
  const std::uint32_t body = maybe(random) ? ball(d, random, {}, 0.6) : box(d, random, {}, {1, 1, 1});
  d.places = {at, lerp(at, to, random.between(0, 1)), lerp(at, to, random.between(0, 1))};
  switch (random.whole(0, 3)) {
    case 0:
      d.bodies = {body, thin};
      break;
    case 1:
      d.bodies = {warped(d, random, d.combined({body, thin}))};
      break;
    default:
      d.bodies = {d.combined({body, thin})};
  }
}

// Balls and tubes whose supports meet in a point, or whose surfaces meet supports, but for a gap.
void supports(BodyDraft& d, Random& random) {
  Records of;
  double edge = 0;
  for (int i = random.whole(2, 4); i > 0; --i) {
    const double r = random.between(0.1, 0.4), range = random.between(0.05, 0.5);
    const double reach = maybe(random) ? r + range : r;
    const double at = edge + reach + gap(random);
    const Vec3d center{at - 1, 0, 0};
    of.push_back(maybe(random, 0.7)
                     ? d.leaf(Sphere{.center = center, .radius = r, .potential = potential(random, range)})
                     : d.leaf(Cylinder{.from = center - Vec3d{0, 0.5, 0},
                                       .to = center + Vec3d{0, 0.5, 0},
                                       .radius = r,
                                       .potential = potential(random, range)}));
    edge = at + (maybe(random) ? r + range : r);
    d.places.push_back({edge - 1, 0, 0});
  }
  d.bodies = {d.blended(of)};
}

std::uint32_t varied_leaf(BodyDraft& d, Random& random) {
  BlendField blend = varied_blend(random, random.whole(0, 109));
  if (maybe(random, 0.3)) blend.distance_segments = {};
  // Integrals of the compact kernel along arcs take 25 us each, and a ray a thousand of them.
  if (blend.kernel == KernelFamily::Compact) blend.arcs = {};
  for (std::size_t i = 0; i < blend.segments.size(); ++i) {
    d.places.push_back(blend.segments.skeletons[i].from);
    d.places.push_back(blend.segments.skeletons[i].to);
  }
  return d.leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(blend))});
}

void kernels(BodyDraft& d, Random& random) {
  const std::uint32_t one = varied_leaf(d, random);
  d.focus_size = 0.3;
  d.bodies = {maybe(random, 0.7) ? one
                                 : d.combined({one, maybe(random) ? varied_leaf(d, random) : some_body(d, random)})};
}

void convolutions(BodyDraft& d, Random& random) {
  std::vector<Vec3d> line{random.vector(1)};
  for (int i = random.whole(2, 5); i > 0; --i) line.push_back(random.vector(1));
  d.places = line;
  d.focus_size = 0.3;
  const double r = pow(10, random.between(-2, -0.3));
  if (maybe(random, 0.4)) {
    d.bodies = {d.leaf(LocalConvolution{.points = line, .radius = {r}, .reach = r * random.between(1, 6)})};
  } else {
    Records of;
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      of.push_back(d.leaf(ConvolutionSegment{line[i], line[i + 1], {r, r * random.between(0.5, 2)}}));
    d.bodies = {d.one_of<Sum, RestrictedBlend, RestrictedBlend, Ricci, SoftUnion>(of)};
  }
  if (maybe(random, 0.3)) d.bodies = {d.combined({d.bodies[0], some_body(d, random)})};
}

// More members than are divided, near each other.
void crowd(BodyDraft& d, Random& random) {
  for (int i = random.whole(65, 80); i > 0; --i) {
    if (maybe(random, 0.1)) {
      d.bodies.push_back(d.combined({d.any(0), d.any(0)}));
    } else {
      const Vec3d at = random.vector(1);
      d.bodies.push_back(ball(d, random, at, pow(10, random.between(-3, -0.7))));
      d.places.push_back(at);
    }
  }
}

using Draw = void (*)(BodyDraft&, Random&);
constexpr std::array<Draw, usual_tree_kinds> draws{any_nodes, creases, warps,        threads,
                                                   supports,  kernels, convolutions, crowd};

}  // namespace

TreeDraft draft_tree(std::size_t kind, const Affine& place, Random& random) {
  BodyDraft draft(random);
  if (kind < usual_tree_kinds) draws[kind](draft, random);
  else if (kind == hundreds_kind) hundreds(draft, random);
  else if (kind == cuts_kind) cuts(draft, random);
  else if (kind == joins_kind) joins(draft, random);
  else draw_odd_bodies(kind - usual_tree_kinds, draft, random);
  return draft.finished(place);
}

}  // namespace marrow::test
