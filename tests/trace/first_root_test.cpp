// First roots against an independent oracle: none missed, none made up, all in place.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "field/trace/sources/far_field.h"
#include "tests/trace/all_cells.h"
#include "tests/trace/large_cells.h"
#include "tests/trace/oracle.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

// A stretch inside is missed if the corrected field gets this far above 1 on it. The traced field may differ by the
// tolerance of 1e-5 of the radius, times the slope of some n - 1 over a radius.
constexpr double grazing_excess = 5e-5;
// Allowed distance of a hit from the exact surface, over the distance to the skeleton.
constexpr double largest_displacement = 2e-5;

struct Tally {
  int rays = 0, hits = 0, missed = 0, phantom = 0, uncertified = 0, grazing = 0;
  double displacement = 0, graze = 0, time_error = 0;
  long evaluations = 0;

  void add(const Tally& b) {
    rays += b.rays;
    hits += b.hits;
    missed += b.missed;
    phantom += b.phantom;
    uncertified += b.uncertified;
    grazing += b.grazing;
    displacement = std::max(displacement, b.displacement);
    graze = std::max(graze, b.graze);
    time_error = std::max(time_error, b.time_error);
    evaluations += b.evaluations;
  }
  void print(const std::string& title) const {
    std::cout << "  " << title << ": " << rays << " rays, " << hits << " hits, missed " << missed << ", phantom "
              << phantom << ", grazing " << grazing << " (excess up to " << graze << "), largest displacement "
              << displacement << ", largest |dt| / radius of the others " << time_error << ", uncertified "
              << uncertified << ", evaluations per ray " << static_cast<double>(evaluations) / rays << '\n';
  }
};

class Judge {
 public:
  explicit Judge(const BlendField& field, std::optional<int> coarse = {}, std::optional<int> fine = {})
      : field_(field),
        oracle_(field_),
        cells_(field, {.instruction_set = "", .coarse_far_degree = coarse, .fine_far_degree = fine}) {}

  std::optional<double> check(Ray ray) {
    ++tally.rays;
    const auto [hit, undecided, evaluations] = cells_.trace(ray);
    tally.evaluations += evaluations;
    if (hit) place(ray, *hit);
    if (undecided < (hit ? hit->t : 1e300)) ++tally.uncertified;
    // The oracle starts where the cells do: there is nothing before, as other tests hold.
    const double size = length(cells_.bounds().size()),
                 middle = dot(cells_.bounds().center() - ray.origin, ray.direction);
    Ray near = ray;
    near.t_min = std::max(0.0, middle - size);
    near.t_max = middle + size;
    const auto truth = oracle_.first_root(near);
    if (truth) compare(near, *truth, hit ? hit->t : near.t_max);
    return hit ? std::optional(hit->t) : std::nullopt;
  }
  const BlendField& field() const { return field_; }

  Tally tally;
  double worst_missed = 0;

 private:
  // A hit must be on the exact surface.
  void place(const Ray& ray, const AllCells::Hit& hit) {
    ++tally.hits;
    const double off = oracle_.displacement(ray.at(hit.t));
    if (off < largest_displacement) tally.displacement = std::max(tally.displacement, off);
    else ++tally.phantom;
  }
  // Nothing worth mentioning may be inside before the hit.
  void compare(const Ray& ray, double truth, double found) {
    const double radius = oracle_.skeleton_distance(ray.at(truth));
    if (std::fabs(found - truth) < 1e-4 * radius) {
      tally.time_error = std::max(tally.time_error, std::fabs(found - truth) / radius);
      return;
    }
    if (found < truth) return;  // judged by place()
    const double excess = oracle_.largest_excess(ray, truth, std::min(found, truth + 4 * radius));
    if (excess < grazing_excess) {
      ++tally.grazing;
      tally.graze = std::max(tally.graze, excess);
      return;
    }
    ++tally.missed;
    worst_missed = std::max(worst_missed, excess);
  }

  BlendField field_;
  Oracle oracle_;
  AllCells cells_;
};

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const int n : {3, 4, 5})
    for (const bool cavity : {true, false})
      for (const double alpha : traced_angles(n, cavity))
        if (cavity || alpha > 0) all.push_back({n, alpha, cavity});  // else holes at every saddle: see the README
  return all;
}

void expect_clean(const Judge& judge, const Setting& s) {
  EXPECT_EQ(judge.tally.missed, 0) << name_of(s) << ", excess up to " << judge.worst_missed;
  EXPECT_EQ(judge.tally.phantom, 0) << name_of(s);
}

TEST(FirstRoot, AgreesWithTheOracle) {
  Random random(71);
  Tally all;
  for (const Setting& s : settings()) {
    const int coarse = random.whole(0, 1) == 0 ? low_far_degree : high_far_degree;
    const int fine = coarse == low_far_degree ? highest_far_degree : high_far_degree;
    Judge judge(random_scene(random, s, random.whole(2, 12)), coarse, fine);
    for (int i = 0; i < 240; ++i) judge.check(any_ray(random, judge.field()));
    expect_clean(judge, s);
    all.add(judge.tally);
  }
  all.print("all kinds");
  EXPECT_GT(all.hits, 1000);
}

// Between a ray that hits and one beside it that does not, the silhouette is found by bisection; the rays on both
// sides of it are the hardest there are.
TEST(FirstRoot, AgreesWithTheOracleAtSilhouettes) {
  Random random(72);
  Tally all;
  for (const Setting& s : settings()) {
    const int coarse = random.whole(0, 1) == 0 ? low_far_degree : high_far_degree;
    const int fine = coarse == low_far_degree ? highest_far_degree : high_far_degree;
    Judge judge(random_scene(random, s, random.whole(2, 7)), coarse, fine);
    for (int i = 0; i < 7; ++i) {
      const Vec3d eye = random_direction(random) * 6;
      Vec3d hit = random.vector(1.2), miss = random.vector(3);
      if (!judge.check(between(eye, hit)) || judge.check(between(eye, miss))) continue;
      for (int k = 0; k < 22; ++k) {
        const Vec3d middle = (hit + miss) * 0.5;
        (judge.check(between(eye, middle)) ? hit : miss) = middle;
      }
    }
    expect_clean(judge, s);
    all.add(judge.tally);
  }
  all.print("silhouettes");
  EXPECT_GT(all.hits, 200);
}

// What lies between t_min and t_max counts, and t does not depend on t_max.
TEST(FirstRoot, KeepsToTheInterval) {
  Random random(73);
  const AllCells cells(random_scene(random, {.degree = 4, .alpha = contact_alpha(4)}, 5));
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    Ray ray = chord(random);
    const auto free = cells.first_hit(ray);
    if (!free) continue;
    ++hits;
    ray.t_max = free->t;
    const auto exact = cells.first_hit(ray);
    ASSERT_TRUE(exact);
    EXPECT_EQ(exact->t, free->t);
    ray.t_max = std::nextafter(free->t, 0.0);
    EXPECT_FALSE(cells.first_hit(ray));
    ray.t_max = ray.t_min = free->t - 1e-3;
    EXPECT_FALSE(cells.first_hit(ray));
  }
  EXPECT_GT(hits, 100);
}

// Where rays are few cells are large, and places in them are rough: not for a thread beside a limb, whose field falls
// with the degree.
TEST(FirstRoot, ThreadsAreExactInLargeCellsAtAnyDegree) {
  Random random(77);
  for (const int n : {4, 8, 12, 20}) {
    BlendField blend;
    blend.degree = n;
    blend.alpha = contact_alpha(n);
    blend.segments.add({{-1.5, 0, 0}, {1.5, 0.2, 0}, 0.3, 0.25}, {});
    const Vec3d at{0.3, 0.5, 0.1}, along{0.01, 0.03, -0.02};
    blend.segments.add({at, at + along, 3e-4, 3e-4}, {});
    const AllCells cells(blend, large_cells());
    int hits = 0;
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
      const UnitVec3 direction = UnitVec3::unchecked(random_direction(random));
      const Vec3d target = at + along * random.between(0, 1) + random.vector(3e-4);
      const Ray ray{target - direction * 5, direction};
      const auto hit = cells.first_hit(ray);
      if (!hit || length(ray.at(hit->t) - target) > 0.01) continue;
      ++hits;
      largest = std::max(largest, std::fabs(corrected_value(blend, ray.at(hit->t)) - 1));
    }
    EXPECT_GT(hits, 500);
    EXPECT_LT(largest, 1e-5) << "n=" << n;
    std::cout << "  n=" << n << ": " << hits << " hits on a thread, the field there is off 1 by " << largest << '\n';
  }
}

// Between two skeletons the scaled field is not straight: a root by one step from a thousandth of the distance was off
// by 1e-5 of it.
TEST(FirstRoot, RootsBetweenSkeletonsAreExact) {
  Random random(78);
  double largest = 0;
  int hits = 0;
  for (const int n : {4, 6, 8}) {
    BlendField blend;
    blend.degree = n;
    blend.alpha = contact_alpha(n);
    blend.segments.add({{-1.3, 0, -0.41}, {1.3, 0, -0.41}, 0.4, 0.4}, {});
    blend.segments.add({{-1.3, -0.2, 0.41}, {1.3, 0.2, 0.41}, 0.4, 0.4}, {});
    const AllCells cells(blend);
    for (int i = 0; i < 3000; ++i) {
      const Vec3d eye = random_direction(random) * 4, target = random.vector(0.6);
      const Ray ray{eye, normalize(target - eye)};
      const auto hit = cells.first_hit(ray);
      if (!hit) continue;
      const BlendSample exact = evaluate(blend, ray.at(hit->t));
      if (!(dot(exact.corrected_gradient, ray.direction) > 0.1 * length(exact.corrected_gradient))) continue;
      ++hits;
      largest = std::max(largest, std::fabs(exact.corrected - 1));
    }
  }
  std::cout << "  " << hits << " hits; the field there is off 1 by " << largest << '\n';
  EXPECT_GT(hits, 3000);
  EXPECT_LT(largest, 2.5e-6);
}

// Gaps beside ordinary roots were given up: what was told as not certified began up to 2.7e-5 off the surface.
TEST(FirstRoot, OnlyWhatTouchesTheSurfaceIsNotCertified) {
  Random random(79);
  BlendField blend;
  blend.alpha = contact_alpha(blend.degree);
  for (int i = 0; i < 60; ++i) blend.points.add({random.vector(1.5), random.between(0.15, 0.35)}, {});
  const AllCells cells(blend);
  int hits = 0, undecided = 0;
  double farthest = 0;  // from 1, where what is not certified begins
  for (int i = 0; i < 60000; ++i) {
    const Ray ray = chord(random);
    const auto found = cells.trace(ray);
    if (!found.hit) continue;
    ++hits;
    if (!(found.undecided < found.hit->t)) continue;
    ++undecided;
    farthest = std::max(farthest, std::fabs(corrected_value(blend, ray.at(found.undecided)) - 1));
  }
  std::cout << "  " << hits << " hits, " << undecided << " not certified, from places on that are off 1 by up to "
            << farthest << '\n';
  EXPECT_GT(hits, 20000);
  EXPECT_LT(farthest, 7e-6);  // the allowance for rounding: 4e-6 of f, and of G
  EXPECT_LE(undecided, hits / 1000);
}

// In scenes that a function of random numbers, a setting and a count of primitives makes.
void expect_the_oracles_roots(Random random, std::initializer_list<Setting> settings, std::initializer_list<int> counts,
                              const char* of, const auto& make_scene) {
  Tally all;
  for (const Setting& s : settings)
    for (const int count : counts) {
      Judge judge(make_scene(random, s, count));
      for (int i = 0; i < 30; ++i) judge.check(any_ray(random, judge.field()));
      expect_clean(judge, s);
      all.add(judge.tally);
    }
  all.print(of);
  EXPECT_GT(all.hits, 100);
}

// Alpha is told by the scene.
constexpr std::initializer_list<Setting> angle_settings{
    {3, 0, true, Projection::Paper}, {3, 0, true, Projection::Exact}, {4, 0, true, Projection::Paper},
    {4, 0, true, Projection::Exact}, {5, 0, true, Projection::Paper}, {5, 0, true, Projection::Exact}};
constexpr std::initializer_list<Setting> below_zero_settings{{3}, {4}, {5}, {8}};
constexpr std::initializer_list<Setting> own_bounds_settings{{3, 0, true, Projection::Paper},
                                                             {4, 0, true, Projection::Exact},
                                                             {5, 0, true, Projection::Paper},
                                                             {8, 0, true, Projection::Paper}};

TEST(FirstRoot, AgreesWithTheOracleWhereEachSkeletonHasItsAngle) {
  expect_the_oracles_roots(Random(75), angle_settings, {2, 9}, "an angle for each skeleton",
                           [](Random& r, const Setting& s, int count) { return random_angled_scene(r, s, count); });
}

TEST(FirstRoot, AgreesWithTheOracleWhereAnglesAreLinearAlongSkeletons) {
  expect_the_oracles_roots(
      Random(102), angle_settings, {2, 9}, "angles along skeletons",
      [](Random& r, const Setting& s, int count) { return with_linear_angles(random_angled_scene(r, s, count), r); });
}

TEST(FirstRoot, AgreesWithTheOracleWhereSomeAnglesAreBelowZero) {
  expect_the_oracles_roots(Random(103), below_zero_settings, {2, 3, 9}, "angles of skeletons, some below 0",
                           [](Random& r, const Setting& s, int count) {
                             return with_angles_below_zero(random_angled_scene(r, s, count), r);
                           });
  expect_the_oracles_roots(Random(104), below_zero_settings, {2, 3, 9}, "angles along skeletons, some below 0",
                           [](Random& r, const Setting& s, int count) {
                             return with_angles_below_zero(with_linear_angles(random_angled_scene(r, s, count), r), r);
                           });
  expect_the_oracles_roots(Random(105), below_zero_settings, {2, 3, 9}, "bounds of strands, some below 0",
                           [](Random& r, Setting s, int count) {
                             s.alpha = 1;
                             BlendField blend = random_stranded_scene(r, s, count);
                             if (count > 2) blend = with_own_bounds(std::move(blend), r);
                             return with_angles_below_zero(std::move(blend), r);
                           });
}

TEST(FirstRoot, AgreesWithTheOracleWhereDirectionsGiveTheAngle) {
  expect_the_oracles_roots(Random(76), angle_settings, {2, 12}, "directions of strands",
                           [](Random& r, Setting s, int count) {
                             s.alpha = 1;
                             return random_stranded_scene(r, s, count);
                           });
}

TEST(FirstRoot, AgreesWithTheOracleWhereEachStrandHasBoundsOfItsOwn) {
  expect_the_oracles_roots(Random(77), own_bounds_settings, {2, 3, 12},
                           "directions of strands with bounds of their own", [](Random& r, Setting s, int count) {
                             s.alpha = 1;
                             return with_own_bounds(random_stranded_scene(r, s, count), r);
                           });
}

}  // namespace
}  // namespace marrow::test
