// Every kernel, model and rule for the angle at the ends of the range of numbers.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "field/blend/angle/local_contact.h"
#include "field/blend/blend_field.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

bool is_number(const Vec3d& v) { return is_finite(v); }

// A skeleton of each kind, around the origin, of a size and a thickness.
BlendField every_skeleton(Random& random, double size, double thickness, int kernel) {
  BlendField blend;
  blend.degree = kernel == 0 ? random.whole(3, 20) : random.whole(3, 12);
  if (kernel == 3) blend.degree = 3;
  if (kernel == 1 || kernel == 2) {
    blend.kernel = kernel == 1 ? KernelFamily::Cauchy : KernelFamily::Compact;
    blend.kernel_shape = kernel == 1 ? exp(random.between(-4, 4)) : 1 + exp(random.between(-4, 4));
  }
  const auto placed = [&](SegmentSkeleton s) {
    return SegmentSkeleton{s.from * size, s.to * size, s.radius_from * thickness, s.radius_to * thickness};
  };
  blend.points.add({random.vector(size), thickness}, {});
  blend.segments.add(placed(random.segment()), {});
  blend.distance_segments.add(placed(random.segment()), {});
  if (kernel == 3) blend.cani_hornus_segments.add(placed(random.segment()), {});
  TriangleSkeleton t = random.triangle();
  for (std::size_t k = 0; k < 3; ++k) {
    t.vertices[k] *= size;
    t.radii[k] *= thickness;
  }
  blend.distance_triangles.add(t, {});
  if (random.between(0, 1) < 0.1) blend.triangles.add(t, {});
  ArcSkeleton arc = random.arc();
  for (double* length : {&arc.major, &arc.center.x, &arc.center.y, &arc.center.z}) *length *= size;
  arc.radius_from *= thickness;
  arc.radius_to *= thickness;
  blend.arcs.add(arc, {});
  blend.distance_arcs.add(arc, {});
  return blend;
}

void give_rule(BlendField& blend, int rule) {
  const auto for_lists = [&](const auto& give) {
    give(blend.points);
    give(blend.segments);
    give(blend.distance_segments);
    give(blend.cani_hornus_segments);
    give(blend.triangles);
    give(blend.distance_triangles);
    give(blend.arcs);
    give(blend.distance_arcs);
  };
  if (rule == 1) {
    blend.alpha_per_skeleton = true;
    for_lists([](auto& list) { list.alphas.assign(list.size(), 0.4); });
    blend.segments.alphas_to = {1.2};
  }
  if (rule == 2) {
    for_lists([&](auto& list) {
      for (std::size_t i = 0; i < list.size(); ++i) {
        list.strands.push_back(static_cast<std::uint32_t>(blend.direction_bounds.size()));
        blend.direction_bounds.push_back({0.1, 1.3});
      }
    });
  }
  if (rule == 3) {
    static const auto contact =
        std::make_shared<const LocalContact>(Kernel{.degree = 4}, true, Projection::Paper, true, true);
    blend.degree = 4;
    blend.local_contact = contact;
  }
}

TEST(Extremes, NothingIsEverNotANumber) {
  Random random(701);
  for (int i = 0; i < 2000; ++i) {
    const int kernel = i % 4, rule = i / 4 % 4;
    if (rule == 3 && kernel != 0) continue;
    const double size = exp(random.between(-34, 34)), thickness = size * exp(random.between(-12, 2));
    BlendField blend = every_skeleton(random, size, thickness, kernel);
    blend.alpha = random.between(0, 1.57);
    blend.cavity = i % 3 != 0;
    blend.projection = i % 2 ? Projection::Paper : Projection::Exact;
    give_rule(blend, rule);
    const Vec3d near = random.vector(2 * size), far = random.vector(1e15);
    const Vec3d on = blend.points.skeletons[0].at, end = blend.segments.skeletons[0].from;
    for (const Vec3d& p : {near, far, on, end, blend.arcs.skeletons[0].center, Vec3d{0, 0, 0}, near * 1e-12}) {
      const BlendSample s = evaluate(blend, p);
      EXPECT_FALSE(std::isnan(s.sum) || std::isnan(s.corrected) || std::isnan(s.alpha)) << i;
      EXPECT_GE(s.corrected, 0) << i;
      EXPECT_TRUE(is_number(s.sum_gradient) && is_number(s.si_gradient)) << i << " sum " << s.sum;
      EXPECT_TRUE(is_number(s.corrected_gradient)) << i << " kernel " << kernel << " rule " << rule << " sum " << s.sum
                                                   << " G " << s.si_norm << " corrected " << s.corrected;
      EXPECT_EQ(s.corrected, corrected_value(blend, p)) << i;
    }
  }
}

// Squares of such distances are 0, or hold a few bits.
TEST(Extremes, PlacesBesideAnEndByHardlyAnythingAreOnTheSkeleton) {
  Random random(702);
  for (const double off : {5e-324, 1e-310, 1e-200, 1e-162, 1e-155, 1e-100}) {
    for (int degree = 3; degree <= 20; ++degree) {
      BlendField blend;
      blend.degree = degree;
      const Vec3d to = random.vector(1);
      const double thin = degree % 2 == 0 ? 0.1 : 0.05;
      blend.segments.add({{0, 0, 0}, to, 0.1, thin}, {});
      if (degree == 3) blend.cani_hornus_segments.add({{0, 0, 0}, to, 0.1, thin}, {});
      if (degree <= 6) blend.triangles.add({{Vec3d{0, 0, 0}, to, random.vector(1)}, {0.1, 0.1, thin}}, {});
      for (const Vec3d& way : {to, to * -1.0, random.vector(1), Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}}) {
        const BlendSample s = evaluate(blend, way * off);
        EXPECT_GT(s.corrected, 1e20) << off << " degree " << degree;
        EXPECT_FALSE(std::isnan(s.corrected) || std::isnan(s.alpha)) << off << " degree " << degree;
        EXPECT_TRUE(is_number(s.corrected_gradient)) << off << " degree " << degree;
      }
    }
  }
}

}  // namespace
}  // namespace marrow
