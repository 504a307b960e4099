// Bodies with blends of many skeletons.
#include "tests/stress/strand_drafts.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

namespace marrow::test {
namespace {

// Strands of many skeletons: far ones become polynomials in parts of space.
BlendField strands(Random& random) {
  BlendField blend;
  blend.degree = random.whole(3, 7);
  if (maybe(random, 0.3)) blend.kernel = KernelFamily::Cauchy;
  blend.alpha = random.between(0, 1.5);
  const double thickness = power_of_ten(random, -2.3, -1);
  for (int strand = random.whole(12, 40); strand > 0; --strand) {
    Vec3d at = random.vector(1), way = random.vector(0.15);
    for (int i = 0; i < 8; ++i) {
      const Vec3d next = at + way;
      const double from = thickness * random.between(0.5, 1.5), to = maybe(random) ? from : 0.5 * from;
      if (maybe(random, 0.1)) blend.points.add({at, 2 * from}, {});
      blend.segments.add({at, next, from, to}, {});
      way += random.vector(0.08);
      at = next;
    }
  }
  return blend;
}

// The same by distance, under any kernel: a strand is a polyline, or, as a file of a neuron, all of them together.
BlendField by_distance(BlendField blend, Random& random) {
  const std::size_t of_strand = maybe(random, 0.3) ? blend.segments.size() : 8;
  for (std::size_t i = 0; i < blend.segments.size(); ++i)
    blend.segments.strands.push_back(static_cast<std::uint32_t>(i / of_strand));
  blend.distance_segments = std::exchange(blend.segments, {});
  if (!maybe(random, 0.3)) return blend;
  blend.kernel = KernelFamily::Compact;
  blend.kernel_shape = random.between(1.2, 3);
  return blend;
}

// A blend that its own tracer knows, in some place.
std::uint32_t traced_strands(BodyDraft& d, Random& random) {
  BlendField blend = strands(random);
  blend.kernel = KernelFamily::Inverse;
  d.focus_size = std::min(d.focus_size, focus_over_radius * blend.segments.skeletons[0].radius_from);
  for (std::size_t i = 0; i < blend.segments.size(); i += 5) d.places.push_back(blend.segments.skeletons[i].to);
  const std::uint32_t leaf = d.leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(blend))});
  if (maybe(random)) return leaf;
  const Vec3d sizes = maybe(random) ? Vec3d{1, 1, 1} : Vec3d{random.between(0.5, 1.5), 1, random.between(0.5, 1.5)};
  return d.placed(Affine::translate(random.vector(0.2)) *
                      Affine::rotate(normalize(random.vector(1)), random.between(-3, 3)) * Affine::scale(sizes),
                  leaf);
}

// What cuts: a plane, a ball, a shell, strands, or any body.
std::uint32_t cutter(BodyDraft& d, Random& random) {
  switch (random.whole(0, 5)) {
    case 0:
      return d.leaf(
          Plane{.point = random.vector(0.4), .normal = normalize(random.vector(1)), .potential = potential(random)});
    case 1:
      return ball(d, random, random.vector(0.7), random.between(0.1, 0.9));
    case 2: {
      const double thickness = power_of_ten(random, -4, -1);
      return d.of(Difference{}, {ball(d, random, {}, 0.7), ball(d, random, {}, 0.7 - thickness)});
    }
    case 3:
      return traced_strands(d, random);
    default:
      return some_body(d, random);
  }
}

// Something small beside or on a strand.
std::uint32_t beside_strand(BodyDraft& d, Random& random) {
  const Vec3d on = d.places[static_cast<std::size_t>(random.whole(0, static_cast<int>(d.places.size()) - 1))];
  const double size = power_of_ten(random, -1.7, -0.4);
  const Vec3d at = on + random.vector(maybe(random) ? 0.1 * size : size);
  d.places.push_back(at);
  switch (random.whole(0, 4)) {
    case 0:
      return box(d, random, at, Vec3d{1, 1, 1} * size);
    case 1: {
      BlendField few;
      few.degree = random.whole(3, 8);
      few.points.add({at, size}, {});
      return d.leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(few))});
    }
    case 2:
      return d.of(Difference{}, {ball(d, random, at, size), ball(d, random, at, 0.9 * size)});
    default:
      return d.leaf(Sphere{.center = at, .radius = size, .potential = potential(random, size)});
  }
}

}  // namespace

void hundreds(BodyDraft& d, Random& random) {
  BlendField blend = strands(random);
  d.focus_size = focus_over_radius * blend.segments.skeletons[0].radius_from;
  for (std::size_t i = 0; i < blend.segments.size(); i += 5) d.places.push_back(blend.segments.skeletons[i].to);
  if (maybe(random, 0.3)) blend = by_distance(std::move(blend), random);
  std::uint32_t one = d.leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(blend))});
  if (maybe(random, 0.6)) one = d.combined({one, some_body(d, random)});
  if (maybe(random, 0.3)) one = d.one_of<Bend, Taper, Twist, Shear>({one});
  if (maybe(random, 0.2))
    one = d.combined({one, d.leaf(BlendLeaf{std::make_shared<const BlendField>(strands(random))})});
  d.bodies = {one};
}

void cuts(BodyDraft& d, Random& random) {
  std::uint32_t one = traced_strands(d, random);
  for (int i = random.whole(1, 3); i > 0; --i) {
    const std::uint32_t other = cutter(d, random);
    switch (random.whole(0, 5)) {
      case 0:
        one = d.one_of<Intersection, SharpIntersection>({one, other});
        break;
      case 1:
        one = d.one_of<Difference, SharpDifference>({other, one});
        break;
      case 2:
        one = d.one_of<CrispUnion, SharpUnion>({other, one});
        break;
      case 3:
        one = d.of(Difference{}, {one, other});
        break;
      default:
        one = d.one_of<Difference, SharpDifference>({one, other});
    }
  }
  d.bodies = {one};
}

void joins(BodyDraft& d, Random& random) {
  std::uint32_t one = traced_strands(d, random);
  for (int i = random.whole(1, 3); i > 0; --i) {
    const std::uint32_t other = beside_strand(d, random);
    if (maybe(random, 0.2)) one = d.one_of<Difference, SharpDifference, CrispUnion>({one, cutter(d, random)});
    switch (random.whole(0, 3)) {
      case 0:
        one = d.one_of<SoftDifference>({one, other});
        break;
      case 1:
        one = d.one_of<SoftUnion, Contact>({other, one});
        break;
      case 2:
        one = d.one_of<SoftUnion, Contact>({one, other});
        break;
      default:
        one = d.one_of<Sum, Ricci, SharpUnion, WeightedBlend, RestrictedBlend>({one, other});
    }
  }
  d.bodies = {one};
}

}  // namespace marrow::test
