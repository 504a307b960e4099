// The same bits from every instruction set, and whether levels of blocks are kept or not.
#include "tests/trace/instruction_sets.h"

#include <bit>
#include <vector>

#include <gtest/gtest.h>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/sources/far_field.h"
#include "tests/trace/all_cells.h"
#include "tests/trace/random_rays.h"
#include "tests/trace/touching_limbs.h"

namespace marrow::test {
namespace {

struct Variant {
  std::string name;
  TraceOptions options;
};

// The sets, and the best of them without memory for blocks, or with memory for what levels are made of alone.
std::vector<Variant> variants_here(int far_degree) {
  std::vector<Variant> all;
  for (const std::string& name : sets_here()) all.push_back({name, {.instruction_set = name}});
  all.push_back({"nothing kept", {.instruction_set = "", .kept_bytes = 0, .compact_bytes = 0}});
  all.push_back({"compact", {.instruction_set = "", .kept_bytes = 0}});
  for (Variant& v : all) {
    v.options.coarse_far_degree = far_degree;
    v.options.eighths = far_degree == high_far_degree;
  }
  return all;
}

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same(const Vec3d& a, const Vec3d& b) { return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z); }

TEST(InstructionSets, UnknownOnesAreRefused) {
  EXPECT_EQ(block_kernels("mmx"), nullptr);
  EXPECT_NE(block_kernels(""), nullptr);
  EXPECT_FALSE(BlendTracer::make(BlendField{}, {.instruction_set = "mmx"}));
}

using Scene = BlendField (*)(Random&, const Setting&);

BlendField one_angle(Random& r, const Setting& s) { return random_scene(r, s, 4); }
BlendField of_skeletons(Random& r, const Setting& s) { return random_angled_scene(r, s, 4); }
BlendField along_skeletons(Random& r, const Setting& s) { return with_linear_angles(of_skeletons(r, s), r); }
BlendField of_directions(Random& r, const Setting& s) { return random_stranded_scene(r, s, 5); }
BlendField of_own_directions(Random& r, const Setting& s) { return with_own_bounds(of_directions(r, s), r); }
template <Scene Make>
BlendField below_zero(Random& r, const Setting& s) {
  return with_angles_below_zero(Make(r, s), r);
}

struct Kind {
  Setting setting;
  Scene make = one_angle;
};

TEST(InstructionSets, GiveTheSameBits) {
  ASSERT_GE(sets_here().size(), 2U) << "nothing to compare on this machine";
  Random random(91);
  int rays = 0, hits = 0;
  const Kind kinds[] = {{{3, 1.0}},
                        {{4, contact_alpha(4)}},
                        {{4, -0.4}},
                        {{5, 0}},
                        {{7, 1.2}},
                        {{4}, of_skeletons},
                        {{5}, along_skeletons},
                        {{4}, of_directions},
                        {{4, 0.8}},
                        {{4}, of_own_directions},
                        {{5}, of_own_directions},
                        {{4}, below_zero<along_skeletons>},
                        {{3}, below_zero<of_own_directions>}};
  int far_degree = high_far_degree;  // in turns
  for (const auto& [s, make] : kinds) {
    const BlendField blend = make(random, s);
    const auto variants = variants_here(far_degree);
    far_degree = far_degree == high_far_degree ? low_far_degree : high_far_degree;
    std::vector<AllCells> tracers;
    for (const Variant& v : variants) tracers.emplace_back(blend, v.options);
    const BlendTracer& first = tracers.front().tracer();
    for (const AllCells& other : tracers) {
      ASSERT_EQ(other.tracer().tile_count(), first.tile_count());
      for (std::size_t i = 0; i < first.tile_count(); ++i) {
        const Box3 a = first.tile_box(i), b = other.tracer().tile_box(i);
        ASSERT_TRUE(same(a.lower, b.lower) && same(a.upper, b.upper));
      }
    }
    for (int i = 0; i < 4000; ++i, ++rays) {
      const Ray ray = any_ray(random, blend);
      const auto expected = tracers.front().trace(ray);
      hits += expected.hit.has_value();
      for (std::size_t k = 1; k < variants.size(); ++k) {
        const auto found = tracers[k].trace(ray);
        ASSERT_EQ(found.hit.has_value(), expected.hit.has_value()) << variants[k].name << ' ' << name_of(s);
        ASSERT_EQ(found.evaluations, expected.evaluations) << variants[k].name << ' ' << name_of(s);
        ASSERT_TRUE(same(found.undecided, expected.undecided)) << variants[k].name << ' ' << name_of(s);
        if (!expected.hit) continue;
        ASSERT_EQ(found.hit->cell, expected.hit->cell) << variants[k].name << ' ' << name_of(s);
        ASSERT_TRUE(same(found.hit->t, expected.hit->t)) << variants[k].name << ' ' << name_of(s);
        const Vec3d p = ray.at(expected.hit->t);
        const SurfacePoint a = first.surface_at(expected.hit->cell, p);
        const SurfacePoint b = tracers[k].tracer().surface_at(expected.hit->cell, p);
        ASSERT_TRUE(same(a.normal.vec(), b.normal.vec()) && same(a.outside, b.outside)) << variants[k].name;
        const UnitVec3 away = normalize(a.normal.vec() + 0.99 * random_direction(random));
        const auto left = tracers.front().trace({a.outside, away, 0, 1e30, &a.around}),
                   also = tracers[k].trace({b.outside, away, 0, 1e30, &b.around});
        ASSERT_EQ(left.hit.has_value(), also.hit.has_value()) << variants[k].name;
        ASSERT_TRUE(!left.hit || same(left.hit->t, also.hit->t)) << variants[k].name;
      }
    }
  }
  std::cout << "  " << rays << " rays, " << hits << " hits on";
  for (const Variant& v : variants_here(low_far_degree)) std::cout << " / " << v.name;
  std::cout << '\n';
  EXPECT_GT(hits, rays / 10);
}

// There steps are proved by places.
TEST(InstructionSets, GiveTheSameStartsWhereLimbsTouch) {
  Random random(92);
  int hits = 0;
  for (const int degree : {3, 4, 5, 6}) {
    const BlendField blend = touching_limbs(random, degree);
    const auto variants = variants_here(low_far_degree);
    std::vector<AllCells> tracers;
    for (const Variant& v : variants) tracers.emplace_back(blend, v.options);
    for (int i = 0; i < 100; ++i) {
      const Ray ray = between_limbs(random);
      const auto hit = tracers.front().first_hit(ray);
      if (!hit) continue;
      ++hits;
      const Vec3d p = ray.at(hit->t), start = tracers.front().tracer().surface_at(hit->cell, p).outside;
      for (std::size_t k = 1; k < variants.size(); ++k)
        ASSERT_TRUE(same(tracers[k].tracer().surface_at(hit->cell, p).outside, start)) << variants[k].name;
    }
  }
  EXPECT_GT(hits, 200);
}

}  // namespace
}  // namespace marrow::test
