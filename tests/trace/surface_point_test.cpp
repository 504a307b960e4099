// Normals are those of the exact closed form.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/trace/all_cells.h"
#include "tests/trace/random_rays.h"

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
    expect_normals_of_varied_angles(random, random_stranded_scene(random, {n, 1, true}, 9), hits);
  }
  EXPECT_GT(hits, 200);
}

}  // namespace
}  // namespace marrow::test
