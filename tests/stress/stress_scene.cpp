// Scenes that are hard to trace.
#include "tests/stress/stress_scene.h"

#include <array>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "field/math/elementary.h"
#include "renderer/geometry/field_solid.h"
#include "tests/stress/odd_drafts.h"
#include "tests/trace/large_cells.h"

namespace marrow::test {
namespace {

// What a kind of scene draws.
struct Draft {
  BlendField blend{};
  Vec3d focus{};
  double focus_size = 1.2;
  double away = 0;  // from the origin, over the scene's size; 0: sometimes a little
};

Setting random_setting(Random& random) {
  Setting s;
  s.degree = random.whole(3, 8);
  s.cavity = random.between(0, 1) < 0.8;
  const auto angles = traced_angles(s.degree, s.cavity);
  s.alpha = s.cavity ? angles[static_cast<std::size_t>(random.whole(0, 3))] : angles[random.whole(1, 2) == 1 ? 1 : 2];
  if (random.between(0, 1) < 0.2) s.alpha = random.between(s.cavity ? -0.8 : 0.2, 1.5);
  return s;
}

Draft skeletons(Random& random) { return {random_scene(random, random_setting(random), random.whole(2, 6))}; }

BlendField blend_of(const Setting& s) {
  BlendField blend;
  blend.degree = s.degree;
  blend.alpha = s.alpha;
  blend.cavity = s.cavity;
  return blend;
}

// A thread of a ten-thousandth of the scene's size beside a thick limb, or growing out of it.
Draft thin_feature(Random& random) {
  Draft d{blend_of(random_setting(random))};
  d.blend.segments.add({{-1.5, 0, 0}, {1.5, 0.2, 0}, 0.3, 0.25}, {});
  const Vec3d at{random.between(-1, 1), random.between(0.32, 0.7), random.between(-0.2, 0.2)};
  const Vec3d along = random_direction(random) * 0.04;
  d.blend.segments.add({at, at + along, 3e-4, 3e-4}, {});
  d.focus = at + along * 0.5;
  d.focus_size = 2e-3;
  return d;
}

// Two limbs side by side whose surfaces are a hair's breadth apart or into each other, on both sides of the angle at
// which they join.
Draft nearly_touching(Random& random) {
  const int degree = random.whole(3, 6);
  const double side = random.between(0, 1) < 0.5 ? -1 : 1, gap = side * pow(10, random.between(-6, -1.5));
  const double turn = (random.between(0, 1) < 0.5 ? -1 : 1) * pow(10, random.between(-5, -2));
  Draft d{blend_of({degree, contact_alpha(degree) + turn})};
  const double r = 0.4, apart = r * (2 + gap), tilt = random.between(0, 1) < 0.5 ? 0 : random.between(0, 0.3);
  d.blend.segments.add({{-1.3, 0, -apart / 2}, {1.3, 0, -apart / 2}, r, r}, {});
  d.blend.segments.add({{-1.3, -tilt, apart / 2}, {1.3, tilt, apart / 2}, r, r}, {});
  d.focus_size = 0.15;
  return d;
}

// Two points two radii apart: just below the angle of contact their middle is outside, with a ring inside around it
// (alpha in (0.92398, 0.93026) for n = 3, (1.16237, 1.16545) for n = 4).
Draft ring(Random& random) {
  const bool cubic = random.between(0, 1) < 0.5;
  Draft d{blend_of({cubic ? 3 : 4, cubic ? random.between(0.92398, 0.93026) : random.between(1.16237, 1.16545)})};
  d.blend.points.add({{-0.7, 0, 0}, 0.7}, {});
  d.blend.points.add({{0.7, 0, 0}, 0.7}, {});
  d.focus_size = 0.3;
  return d;
}

// A closed loop of segments around a hole that nearly closes.
Draft loop(Random& random) {
  const int degree = random.whole(3, 5), pieces = 12;
  Draft d{blend_of({degree, contact_alpha(degree) + random.between(-0.2, 0.2)})};
  const double major = random.between(0.5, 0.62), minor = random.between(0.42, 0.5);
  const auto at = [&](int i) {
    const double a = 2 * std::numbers::pi * i / pieces;
    return Vec3d{major * cos(a), major * sin(a), 0};
  };
  for (int i = 0; i < pieces; ++i) d.blend.segments.add({at(i), at(i + 1), minor, minor}, {});
  d.focus_size = 0.25;
  return d;
}

// Skeletons that hardly are: as short as a rounding, twice in the same place, one inside another, pointed at one end or
// at both, a joint of a straight line.
Draft degenerate(Random& random) {
  Draft d{random_scene(random, random_setting(random), random.whole(2, 4))};
  auto& segments = d.blend.segments;
  const Vec3d at = random.vector(0.8), along = random_direction(random);
  const double r = random.between(0.1, 0.35);
  segments.add({at, at + along * pow(10, random.between(-12, -3)), r, r}, {});
  segments.add(segments.skeletons[0], {});
  segments.add({at, at - along, r, random.between(0, 1) < 0.5 ? 0.0 : r * pow(10, random.between(-6, -1))}, {});
  segments.add({at, at + along * 0.5, r, r}, {});
  segments.add({at + along * 0.5, at + along, r, r}, {});
  segments.add({at + along * 0.2, at + along * 0.7, 0.5 * r, 0.5 * r}, {});
  d.blend.points.add({at - along * 0.5, 0.2}, {});
  d.blend.points.add({at - along * 0.5, 0.2}, {});
  d.focus = at;
  d.focus_size = r;
  return d;
}

// A ball, and on it smaller and smaller ones down to a ten-thousandth, and a hair of that size.
Draft ratios(Random& random) {
  Draft d{blend_of(random_setting(random))};
  const Vec3d out = random_direction(random);
  d.blend.points.add({{0, 0, 0}, 0.8}, {});
  double radius = 0.8, surface = radius;
  while (radius > 2e-4) {
    radius *= random.between(0.1, 0.4);
    surface += radius;
    d.blend.points.add({out * surface, radius}, {});
  }
  const Vec3d tip = out * surface;
  d.blend.segments.add({tip, tip + random_direction(random) * (40 * radius), radius, radius}, {});
  d.focus = tip;
  d.focus_size = pow(10, random.between(-4, -0.5));
  return d;
}

Draft far_away(Random& random) {
  Draft d = skeletons(random);
  d.away = pow(10, random.between(2, 5));
  return d;
}

Setting varied_setting(Random& random) {
  return {random.whole(3, 6), 1, true, random.between(0, 1) < 0.5 ? Projection::Paper : Projection::Exact};
}

// An angle for each skeleton.
Draft angles(Random& random) { return {random_angled_scene(random, varied_setting(random), random.whole(2, 9))}; }

// An angle by the directions of strands.
Draft strands(Random& random) { return {random_stranded_scene(random, varied_setting(random), random.whole(2, 16))}; }

using Draw = Draft (*)(Random&);
constexpr std::array<Draw, single_angle_kinds + varied_kinds> draws{
    skeletons, thin_feature, nearly_touching, ring, loop, degenerate, ratios, far_away, angles, strands};

void scale(BlendField& blend, double by, const Vec3d& move) {
  for (auto& s : blend.points.skeletons) s = {s.at * by + move, s.radius * by};
  for (auto& s : blend.segments.skeletons)
    s = {s.from * by + move, s.to * by + move, s.radius_from * by, s.radius_to * by};
}

std::size_t kind_of(std::uint64_t number) {
  if (number >= first_odd_scene) return single_angle_kinds + varied_kinds + number % odd_kind_count;
  return number < first_varied_scene ? number % single_angle_kinds : single_angle_kinds + number % varied_kinds;
}

Draft draft_of(std::size_t kind, Random& random) {
  return kind < draws.size() ? draws[kind](random) : Draft{odd_blend(kind - draws.size(), random)};
}

// Of every other scene of varying angles these are linear along skeletons, or strands have bounds of their own, and of
// half of those some are below 0: from numbers of its own, so that what all scenes are does not depend on it.
BlendField with_other_angles(BlendField blend, std::uint64_t number) {
  if (number < first_varied_scene || number >= first_odd_scene || number / varied_kinds % 2 == 0) return blend;
  Random random(~number, Random::Silent{});
  blend = blend.alpha_per_skeleton ? with_linear_angles(std::move(blend), random)
                                   : with_own_bounds(std::move(blend), random);
  return number / varied_kinds % 4 == 1 ? blend : with_angles_below_zero(std::move(blend), random);
}

}  // namespace

// Half of the scenes keep their size; the others are from 1e-4 to 1e4 of it, and some stand far from the origin.
StressScene::StressScene(std::uint64_t number) {
  Random random(number, Random::Silent{});
  kind_ = kind_of(number);
  Draft draft = draft_of(kind_, random);
  draft.blend = with_other_angles(std::move(draft.blend), number);
  const double factor = random.between(0, 1) < 0.5 ? 1 : pow(10, random.between(-4, 4));
  const double away = draft.away > 0 ? draft.away : random.between(0, 1) < 0.8 ? 0 : 30;
  const Vec3d move = random.vector(away * factor);
  scale(draft.blend, factor, move);
  blend_ = std::move(draft.blend);
  size_ *= factor;
  center_ = move;
  focus_ = draft.focus * factor + move;
  focus_size_ = draft.focus_size * factor;
  name_ = std::to_string(number) + " (" + kind_names[kind_] + ", " +
          name_of({blend_.degree, blend_.alpha, blend_.cavity}) + ", scale " + std::to_string(factor) + ")";
  build(number);
}

// Half of the scenes are divided for many rays; the others for so few that cells are as large as they may be, in tiles
// of small or of many primitives. Half of either have eighths of slots.
TraceOptions options_of(std::uint64_t number) {
  TraceOptions options;
  const std::uint64_t way = number / single_angle_kinds % 4;
  if (way >= 2) options.spacing = hardly_a_ray();
  options.eighths = way % 2 == 1;
  if (way == 3) options.cells = {.cell_size = 1.6, .tile_levels = 2};
  return options;
}

void StressScene::build(std::uint64_t number) {
  // If space far away were not dropped, cells would take all memory. The table that the tracer makes of the operator
  // is held to it elsewhere; making it twice would take a twentieth of the time of all rays.
  if (!(correction_of(blend_).value(0.01, 0.01) < 1)) throw std::runtime_error("tiny fields are not outside");
  auto solid = FieldSolid::make({blend_, {}, {}}, MaterialId{}, options_of(number));
  if (!solid) throw std::runtime_error("scene " + name_ + " cannot be traced");
  std::vector<PlacedSolid> solids;
  solids.push_back({std::move(*solid), ObjectId{0}});
  auto made = EmbreeSurfaces::make(std::move(solids), {}, "threads=1");
  if (!made) throw std::runtime_error("scene " + name_ + " has no surfaces");
  surfaces_ = std::move(*made);
  oracle_ = std::make_unique<Oracle>(blend_);
  proof_ = std::make_unique<WayProof>(blend_, 1 + 0.5 * grazing_excess(), 1 - grazing_excess());
  const Solid& all = *surfaces_->solids()[0].solid;
  for (std::size_t i = 0; i < all.element_count(); ++i) cells_.include(all.element_box(i));
}

Box3 StressScene::random_cell(Random& random) const {
  const Solid& all = *surfaces_->solids()[0].solid;
  return all.element_box(static_cast<std::size_t>(random.whole(0, static_cast<int>(all.element_count()) - 1)));
}

}  // namespace marrow::test
