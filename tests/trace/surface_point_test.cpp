// Normals are those of the exact closed form, and starts beside the surface are outside.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tests/trace/all_cells.h"
#include "tests/trace/large_cells.h"
#include "tests/trace/random_rays.h"
#include "tests/trace/touching_limbs.h"

namespace marrow::test {
namespace {

// At the border of the cavity branch the gradient of the published operator jumps by some degrees.
bool near_kink(const BlendField& blend, const BlendSample& s) {
  const Correction c(blend.degree, s.alpha, blend.cavity, blend.projection);
  const bool here = c.in_cavity_branch(s.sum, s.si_norm);
  for (const double f : {0.999, 1.001})
    for (const double g : {0.999, 1.001})
      if (c.in_cavity_branch(s.sum * f, s.si_norm * g) != here) return true;
  return false;
}

TEST(SurfacePoint, NormalIsThatOfTheExactField) {
  Random random(81);
  int hits = 0, kinks = 0, steep = 0;
  double worst = 0;
  for (const int n : {3, 4, 5})
    for (const bool cavity : {true, false})
      for (const double alpha : traced_angles(n, cavity)) {
        if (!cavity && alpha <= 0) continue;
        const Setting s{n, alpha, cavity};
        const AllCells cells(random_scene(random, s, random.whole(2, 9)));
        for (int i = 0; i < 150; ++i) {
          const Ray ray = any_ray(random, cells.tracer().field());
          const auto hit = cells.first_hit(ray);
          if (!hit) continue;
          ++hits;
          const SurfacePoint found = cells.tracer().surface_at(hit->cell, ray.at(hit->t));
          const BlendSample exact = evaluate(cells.tracer().field(), ray.at(hit->t));
          EXPECT_NEAR(length(found.normal), 1, 1e-14);
          if (near_kink(cells.tracer().field(), exact)) {
            ++kinks;
            continue;
          }
          // Where the gradient nearly vanishes its direction is known less well.
          const double radius = largest_radius(cells.tracer().field());
          const double slope = length(exact.corrected_gradient) * radius;
          const double allowed = slope > 1 ? 1e-4 : 1e-4 / slope;
          steep += slope > 1;
          const double off = length(found.normal + normalize(exact.corrected_gradient).vec());
          EXPECT_LT(off, allowed) << name_of(s) << " gradient times radius " << slope;
          if (slope > 1) worst = std::max(worst, off);
        }
      }
  std::cout << "  " << hits << " hits, largest error of the normal " << worst << " (of " << steep << "), " << kinks
            << " near a kink left out\n";
  EXPECT_GT(hits, 1000);
  EXPECT_LT(kinks, hits / 10);
}

// As far as quadratics of far strands tell the gradient of the angle.
void expect_normals_of_varied_angles(Random& random, const BlendField& blend, int& hits) {
  const AllCells cells(blend);
  for (int i = 0; i < 150; ++i) {
    const Ray ray = any_ray(random, cells.tracer().field());
    const auto hit = cells.first_hit(ray);
    if (!hit) continue;
    const BlendSample exact = evaluate(cells.tracer().field(), ray.at(hit->t));
    if (near_kink(cells.tracer().field(), exact) || length(exact.corrected_gradient) < 1) continue;
    ++hits;
    const SurfacePoint found = cells.tracer().surface_at(hit->cell, ray.at(hit->t));
    EXPECT_LT(length(found.normal + normalize(exact.corrected_gradient).vec()), 2e-3);
    EXPECT_LT(corrected_value(cells.tracer().field(), found.outside), 1);
  }
}

TEST(SurfacePoint, NormalIsThatOfTheExactFieldWhereTheAngleVaries) {
  Random random(84);
  int hits = 0;
  for (const int n : {3, 4, 5}) {
    expect_normals_of_varied_angles(random, random_angled_scene(random, {n, 0, true}, 7), hits);
    const BlendField linear = with_linear_angles(random_angled_scene(random, {n, 0, true}, 7), random);
    expect_normals_of_varied_angles(random, linear, hits);
    expect_normals_of_varied_angles(random, random_stranded_scene(random, {n, 1, true}, 9), hits);
    const BlendField own = with_own_bounds(random_stranded_scene(random, {n, 1, true}, 9), random);
    expect_normals_of_varied_angles(random, own, hits);
    expect_normals_of_varied_angles(random, with_angles_below_zero(own, random), hits);
  }
  EXPECT_GT(hits, 200);
}

// The shortest of steps along the normal, each twice the one before, from which C is below 1 by more than errors of
// blocks and rounding take; none up to a twentieth of the distance to the skeletons.
std::optional<double> clear_step(const BlendField& blend, const Vec3d& hit, const UnitVec3& normal, double distance) {
  for (double step = 1e-5 * distance; step < 0.05 * distance; step *= 2)
    if (corrected_value(blend, hit + normal * step) < 1 - 1e-4) return step;
  return {};
}

// There C hardly changes along the limbs, and bounds about a hit prove next to nothing. Starts are outside, and not
// farther away than they have to be.
TEST(SurfacePoint, StartsBetweenLimbsThatTouchAreOutside) {
  Random random(85);
  int hits = 0, flat = 0;
  double deepest = 0;
  for (int scene = 0; scene < 60; ++scene) {
    const AllCells cells(touching_limbs(random, random.whole(3, 6)), scene % 2 ? large_cells() : TraceOptions{});
    const BlendField& blend = cells.tracer().field();
    for (int i = 0; i < 40; ++i) {
      const Ray ray = between_limbs(random);
      const auto hit = cells.first_hit(ray);
      if (!hit) continue;
      const Vec3d p = ray.at(hit->t);
      const SurfacePoint found = cells.tracer().surface_at(hit->cell, p);
      const auto step = clear_step(blend, p, found.normal, 0.4);
      if (!step) continue;
      ++hits;
      flat += length(evaluate(blend, p).corrected_gradient) < 0.02;
      const double value = corrected_value(blend, found.outside);
      deepest = std::max(deepest, 1 - value);
      EXPECT_LT(value, 1) << "n " << blend.degree << ", alpha " << blend.alpha << " at x " << p.x << ", y " << p.y;
      EXPECT_LT(length(found.outside - p), 2 * *step);
    }
  }
  std::cout << "  " << hits << " hits, " << flat << " where C is flat, starts down to 1 - " << deepest << '\n';
  EXPECT_GT(flat, 500);
}

// Cones that meet in a point, so far from the origin that coordinates do not resolve it: bounds prove steps that are
// lost as they are added, and the places of hits are inside by what is rounded of them.
TEST(SurfacePoint, StartsBesidePointsOfConesFarAwayAreOutside) {
  Random random(83);
  int hits = 0;
  for (const double alpha : {0.0003, 0.8}) {
    const Vec3d tip = random.vector(1) * 5e4, to = normalize(random.vector(1)) * 0.5;
    BlendField blend;
    blend.degree = 3;
    blend.alpha = alpha;
    blend.segments.add({tip - to, tip, 0.02, 1e-10}, {});
    blend.segments.add({tip, tip + to, 1e-10, 0.02}, {});
    const AllCells cells(blend);
    for (int i = 0; i < 4000; ++i) {
      const Vec3d at = tip + normalize(random.vector(1)) * pow(10, random.between(-10, -1));
      const Vec3d eye = at + normalize(random.vector(1)) * random.between(0.5, 5);
      const Ray ray{eye, normalize(at - eye)};
      const auto hit = cells.first_hit(ray);
      if (!hit) continue;
      ++hits;
      const Vec3d start = cells.tracer().surface_at(hit->cell, ray.at(hit->t)).outside;
      EXPECT_LT(corrected_value(blend, start), 1)
          << "alpha " << alpha << ", " << length(start - tip) << " from the tip";
    }
  }
  EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace marrow::test
