// Packets of rays find what single rays find, to the same bits, on every instruction set.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/trace/first_of_tiles.h"
#include "tests/trace/instruction_sets.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

using Rays = std::array<Ray, RayPacket::size>;

std::uint64_t bits(double v) { return std::bit_cast<std::uint64_t>(v); }

// Of the pixels of a small picture, as wide as a tenth of a body, through a place near the surface.
Rays neighbours(Random& random, const BlendField& blend) {
  const Ray middle = random.whole(0, 1) == 0 ? tangent(random, blend) : chord(random);
  Rays rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double x = static_cast<double>(i % 8), y = static_cast<double>(i / 8);
    const Vec3d moved = middle.direction.vec() + Vec3d{0.002 * x, 0.002 * y, -0.001 * y};
    rays[i] = {middle.origin, normalize(moved)};
  }
  return rays;
}

Rays strangers(Random& random, const BlendField& blend) {
  Rays rays;
  for (Ray& ray : rays) ray = any_ray(random, blend);
  return rays;
}

using Starts = std::array<SurfacePoint, RayPacket::size>;

// From beside the surface, as shadow rays begin, most of them with what is known there; from anywhere, even inside,
// where nothing was met.
Rays leaving(Random& random, const BlendTracer& tracer, const Rays& arriving, Starts& starts) {
  const UnitVec3 light = UnitVec3::unchecked(random_direction(random));
  Rays rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = {random.vector(1.5), UnitVec3::unchecked(random_direction(random))};
    for (std::size_t tile = 0; tile < tracer.tile_count(); ++tile) {
      CellLog log;
      const auto hit = tracer.first_hit(tile, arriving[i], false, log);
      if (!hit) continue;
      starts[i] = tracer.surface_at(*hit->block, arriving[i].at(hit->t));
      rays[i] = {starts[i].outside, light};
      if (random.whole(0, 3) != 0) rays[i].around = &starts[i].around;
      if (random.whole(0, 3) == 0) rays[i].t_max = random.between(0.1, 2);
      break;
    }
  }
  return rays;
}

constexpr LaneSet all = LaneSet::range(0, RayPacket::size);

// One, a few, or about half of them.
LaneSet some_lanes(Random& random) {
  LaneSet lanes;
  const double share = std::exp2(random.between(-6, 0));
  for (std::size_t i = 0; i < RayPacket::size; ++i)
    if (random.between(0, 1) < share) lanes.add(i);
  lanes.add(static_cast<std::size_t>(random.whole(0, RayPacket::size - 1)));
  return lanes;
}

struct Compared {
  int rays = 0, hits = 0, entered_inside = 0;
};

void expect_same(const CellHits& found, std::size_t i, const std::optional<CellHit>& expected, const CellLog& log) {
  const CellLog& given = found.log[i];
  ASSERT_EQ(found.hit[i].block != nullptr, expected.has_value()) << "lane " << i;
  ASSERT_EQ(given.evaluations, log.evaluations) << "lane " << i;
  ASSERT_EQ(bits(given.undecided), bits(log.undecided)) << "lane " << i;
  ASSERT_EQ(given.side, log.side) << "lane " << i;
  ASSERT_EQ(bits(given.enter), bits(log.enter)) << "lane " << i;
  ASSERT_EQ(bits(given.outside_from), bits(log.outside_from)) << "lane " << i;
  if (!expected) return;
  ASSERT_EQ(bits(found.hit[i].t), bits(expected->t)) << "lane " << i;
  ASSERT_EQ(found.hit[i].block, expected->block) << "lane " << i;
}

void expect_same_in_tiles(const BlendTracer& tracer, const Rays& rays, LaneSet asked, bool any) {
  const RayPacket packet(rays);
  for (std::size_t tile = 0; tile < tracer.tile_count(); ++tile) {
    CellHits found;
    tracer.first_hits(tile, packet, asked, any, found);
    asked.for_each([&](std::size_t i) {
      CellLog log;
      const auto expected = tracer.first_hit(tile, rays[i], any, log);
      expect_same(found, i, expected, log);
    });
  }
}

using Places = std::array<std::size_t, RayPacket::size>;  // the part of each ray

void expect_same_in_parts(const BlendTracer& tracer, const std::vector<TracePart>& parts, const Places& part_of,
                          const Rays& rays, LaneSet asked, bool any) {
  std::map<std::size_t, LaneSet> in_part;
  asked.for_each([&](std::size_t i) { in_part[part_of[i]].add(i); });
  std::vector<PartRays> together;
  for (const auto& [part, lanes] : in_part) together.push_back({parts[part], lanes});
  CellHits found;
  tracer.first_hits(together, RayPacket(rays), any, found);
  asked.for_each([&](std::size_t i) {
    CellLog log;
    const auto expected = tracer.first_hit(parts[part_of[i]], rays[i], any, log);
    expect_same(found, i, expected, log);
  });
}

// Each in a part of its own, or with some others.
Places mixed(Random& random, std::size_t parts) {
  const int last = static_cast<int>(parts) - 1, some = std::min(last, random.whole(0, 20));
  Places places;
  for (std::size_t& place : places)
    place = static_cast<std::size_t>(last - random.whole(0, random.whole(0, 1) == 0 ? some : last));
  return places;
}

// Through the middles of their parts.
Rays through(Random& random, const std::vector<TracePart>& parts, const Places& part_of) {
  Rays rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Box3& box = parts[part_of[i]].box;
    const Vec3d from = random.vector(3);
    rays[i] = {from, normalize(box.lower + box.size() * 0.5 - from)};
  }
  return rays;
}

void expect_same(const BlendTracer& tracer, const Rays& rays, LaneSet asked, bool any, Compared& count) {
  expect_same_in_tiles(tracer, rays, asked, any);
  Random mixing = Random::stream(static_cast<std::uint64_t>(count.rays));
  const std::vector<TracePart> parts = tracer.parts();
  const Places places = mixed(mixing, parts.size());
  expect_same_in_parts(tracer, parts, places, rays, asked, any);
  expect_same_in_parts(tracer, parts, places, through(mixing, parts, places), asked, any);
  const RayPacket packet(rays);
  std::array<double, RayPacket::size> outside_from{};
  outside_from.fill(std::numeric_limits<double>::infinity());
  for (const TracePart& part : tracer.parts()) {
    CellHits found;
    for (std::size_t i = 0; i < rays.size(); ++i) found.log[i].outside_from = outside_from[i];
    const PartRays all_in_part{part, asked};
    tracer.first_hits(std::span(&all_in_part, 1), packet, any, found);
    asked.for_each([&](std::size_t i) {
      CellLog log;
      log.outside_from = outside_from[i];
      const auto expected = tracer.first_hit(part, rays[i], any, log);
      expect_same(found, i, expected, log);
      count.entered_inside += log.side == Side::Inside;
      count.hits += expected.has_value();
      outside_from[i] = log.outside_from;
    });
  }
  count.rays += asked.count();
}

class Packets : public testing::TestWithParam<Setting> {};

TEST_P(Packets, FindWhatSingleRaysFind) {
  Random random(4711);
  const BlendField blend = random_scene(random, GetParam(), 7);
  Starts starts;
  for (const std::string& set : sets_here()) {
    auto made = BlendTracer::make(blend, {.instruction_set = set});
    ASSERT_TRUE(made);
    const BlendTracer& tracer = **made;
    ASSERT_TRUE(tracer.traces_packets());
    for (int i = 0; i < 500; ++i) first_hit(tracer, any_ray(random, blend));  // divides space
    Compared count;
    for (int i = 0; i < 16; ++i) {
      const LaneSet asked = some_lanes(random);
      const bool any = random.whole(0, 1) == 0;
      const Rays near = neighbours(random, blend);
      expect_same(tracer, near, all, any, count);
      expect_same(tracer, near, asked, false, count);
      expect_same(tracer, leaving(random, tracer, near, starts), all, any, count);
      expect_same(tracer, strangers(random, blend), asked, any, count);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(count.hits, count.rays / 4);
    EXPECT_GT(count.entered_inside, 0);
    std::cout << "  " << set << ": " << count.rays << " rays, " << count.hits << " hits in parts, "
              << count.entered_inside << " found to begin inside\n";
  }
}

INSTANTIATE_TEST_SUITE_P(Trace, Packets,
                         testing::Values(Setting{3, 1.0}, Setting{4, contact_alpha(4)}, Setting{4, -0.4},
                                         Setting{4, std::numbers::pi / 2}, Setting{5, 0}, Setting{7, 1.2}));

// Then the levels of two cells of a packet may lie in the same memory, one after the other.
TEST(PacketsWithoutKeptLevels, FindWhatSingleRaysFind) {
  Random random(4713);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 7);
  for (const std::string& set : sets_here()) {
    auto made = BlendTracer::make(blend, {.instruction_set = set, .kept_bytes = 0, .compact_bytes = 0});
    ASSERT_TRUE(made);
    const BlendTracer& tracer = **made;
    for (int i = 0; i < 200; ++i) first_hit(tracer, any_ray(random, blend));
    const std::vector<TracePart> parts = tracer.parts();
    std::cout << "  " << set << ": " << parts.size() << " parts\n";
    for (int i = 0; i < 12; ++i) {
      const bool any = random.whole(0, 1) == 0;
      const Places places = mixed(random, parts.size());
      expect_same_in_parts(tracer, parts, places, through(random, parts, places), all, any);
    }
  }
}

TEST(PacketsOfVariedAngles, FindWhatSingleRaysFind) {
  Random random(4712);
  Compared count;
  Starts starts;
  for (const BlendField& blend :
       {random_angled_scene(random, {4, 0}, 5), with_linear_angles(random_angled_scene(random, {4, 0}, 5), random),
        random_stranded_scene(random, {4, 0}, 5), random_stranded_scene(random, {5, 0}, 5),
        with_own_bounds(random_stranded_scene(random, {4, 0}, 5), random),
        with_angles_below_zero(random_angled_scene(random, {3, 0}, 5), random),
        with_angles_below_zero(with_own_bounds(random_stranded_scene(random, {4, 0}, 5), random), random)})
    for (const std::string& set : sets_here()) {
      auto made = BlendTracer::make(blend, {.instruction_set = set});
      ASSERT_TRUE(made);
      const BlendTracer& tracer = **made;
      for (int i = 0; i < 200; ++i) first_hit(tracer, any_ray(random, blend));
      for (int i = 0; i < 4; ++i) {
        const bool any = random.whole(0, 1) == 0;
        const Rays near = neighbours(random, blend);
        expect_same(tracer, near, all, any, count);
        expect_same(tracer, near, some_lanes(random), false, count);
        expect_same(tracer, leaving(random, tracer, near, starts), all, any, count);
        expect_same(tracer, strangers(random, blend), all, any, count);
        if (HasFatalFailure()) return;
      }
    }
  EXPECT_GT(count.hits, 0);
  EXPECT_GT(count.entered_inside, 0);
}

}  // namespace
}  // namespace marrow::test
