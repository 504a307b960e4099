// Bounds of means, and of angles that are means, against their derivatives at places all over the ball.
#include "field/blend/bounds/angle/mean_angles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/bounds/angle/field_weight.h"
#include "field/blend/bounds/angle/mean_bounds.h"
#include "field/number/functions.h"
#include "field/number/variables_at.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

double slope_length(const HessianJet& x) { return length(gradient_of(x)); }
Vec3d bend_along(const HessianJet& x, const Vec3d& d) {
  Vec3d bend{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = HessianJet::at[k];
    bend[i] += x.curvature[k] * d[j];
    if (i != j) bend[j] += x.curvature[k] * d[i];
  }
  return bend;
}

// g . p + k/2 (d . p)^2, whose slope changes by |k| d^2 over a length of 1.
struct Quadratic {
  double base;
  Vec3d g, d;
  double k;
  HessianJet at(const Vec3d& p) const {
    const auto x = variables_at<HessianJet>(p);
    const HessianJet along = x.x * d.x + x.y * d.y + x.z * d.z;
    return base + (x.x * g.x + x.y * g.y + x.z * g.z) + 0.5 * k * square(along);
  }
  double bend() const { return std::fabs(k) * dot(d, d); }
};

Quadratic random_quadratic(Random& random, double steep, double bent) {
  return {random.between(-1, 1), random.vector(steep), normalize(random.vector(1)).vec(), random.between(-bent, bent)};
}

TEST(MeanBounds, HoldTheDerivativesOfMeans) {
  Random random(63);
  double least_slack = 1e9;
  for (int i = 0; i < 2000; ++i) {
    const double rho = pow(10, random.between(-4, -0.3)), steep = random.between(0, 5);
    const Vec3d common = random.vector(20);
    std::vector<Quadratic> logs, values;
    std::vector<MeanTerm> terms;
    double weights = 0, mean = 0;
    for (int k = random.whole(1, 6); k > 0; --k) {
      logs.push_back(random_quadratic(random, steep, random.between(0, 10)));
      logs.back().g += common;
      values.push_back(random_quadratic(random, random.between(0, 2), random.between(0, 4)));
      const double w = exp(logs.back().base);
      const FieldWeight weight{.value = w, .log = LogWeight{logs.back().g, logs.back().bend()}};
      terms.push_back(weight.term(common, rho));
      terms.back().value_slope = length(values.back().g) + values.back().bend() * rho;
      terms.back().value_bend = values.back().bend();
      weights += w;
      mean += w * values.back().base;
    }
    for (std::size_t k = 0; k < terms.size(); ++k) terms[k].apart = std::fabs(values[k].base - mean / weights);
    const double widest = 2 + 40 * rho;
    const MeanChange change = mean_change(terms, widest, rho);
    for (int k = 0; k < 10; ++k) {
      const Vec3d p = normalize(random.vector(1)) * (k == 0 ? 0 : random.between(0, rho));
      HessianJet sum, weighted;
      for (std::size_t t = 0; t < terms.size(); ++t) {
        const HessianJet w = exp(logs[t].at(p));
        sum += w;
        weighted += w * values[t].at(p);
      }
      const HessianJet m = weighted / sum;
      const Vec3d d = normalize(random.vector(1)).vec();
      EXPECT_LE(slope_length(m), change.slope * (1 + 1e-6) + 1e-9) << i;
      EXPECT_LE(length(bend_along(m, d)), change.bend * (1 + 1e-6) + 1e-6) << i;
      if (k == 0) least_slack = std::min(least_slack, (change.bend + 1e-9) / (length(bend_along(m, d)) + 1e-9));
    }
  }
  std::cout << "  bounds are " << least_slack << " times as large, at least\n";
  EXPECT_LT(least_slack, 3);
}

TEST(MeanBounds, KnowNothingOfWeightsThatMayBecomeAnything) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const FieldWeight steep{.value = 1, .log = LogWeight{{1e3, 0, 0}, 0}};
  const std::vector<MeanTerm> terms{steep.term({}, 0.1)};
  EXPECT_EQ(mean_change(terms, 1, 0.1).slope, inf);
  const std::vector<MeanTerm> nothing{{.weight = {0, 1}, .slope = 1, .bend = 1}};
  EXPECT_EQ(mean_change(nothing, 1, 0.1).slope, inf);
  EXPECT_EQ(mean_change({}, 1, 0.1).slope, inf);
  const std::vector<MeanTerm> kinked{{.weight = {1, 2}, .slope = 1, .bend = inf, .apart = 1}};
  EXPECT_LT(mean_change(kinked, 1, 0.1).slope, inf);
  EXPECT_EQ(mean_change(kinked, 1, 0.1).bend, inf);
}

void give_kernel(BlendField& blend, Random& random) {
  const double kind = random.between(0, 1);
  if (kind > 0.5) return;
  blend.kernel = kind < 0.2 ? KernelFamily::Cauchy : KernelFamily::Compact;
  blend.kernel_shape = kind < 0.2 ? random.between(0.5, 2) : random.between(1.5, 5);
}

// Strands that turn, with points among them, arcs, triangles, the distance model; more strands than are taken pair by
// pair.
BlendField blend_of_strands(Random& random) {
  BlendField blend;
  blend.degree = random.whole(3, 8);
  give_kernel(blend, random);
  const int strands = random.between(0, 1) < 0.2 ? random.whole(13, 30) : random.whole(2, 6);
  for (int strand = 0; strand < strands; ++strand) {
    const auto number = static_cast<std::uint32_t>(strand);
    blend.direction_bounds.push_back({random.between(-0.4, 1), random.between(0, 1.5)});
    const double kind = random.between(0, 1);
    const auto add = [&](auto& list, const auto& skeleton) {
      list.add(skeleton, {});
      list.strands.push_back(number);
    };
    if (kind < 0.15) add(blend.points, random.point());
    else if (kind < 0.25) add(blend.arcs, random.arc());
    else if (kind < 0.3) add(blend.triangles, random.triangle());
    else if (kind < 0.4) {
      SegmentSkeleton s = random.segment();
      for (int k = random.whole(1, 3); k > 0; --k) {
        add(blend.distance_segments, s);
        s = {s.to, s.to + random.vector(1), s.radius_to, random.between(0.2, 0.8)};
      }
    } else if (kind < 0.42) add(blend.distance_triangles, random.triangle());
    else if (kind < 0.5) add(blend.distance_arcs, random.arc());
    else {
      SegmentSkeleton s = random.segment();
      const double turns = random.between(0, 1.2);
      for (int k = random.whole(1, 4); k > 0; --k) {
        add(blend.segments, s);
        const Vec3d way = (s.to - s.from) + random.vector(turns) * length(s.to - s.from);
        s = {s.to, s.to + way, s.radius_to, random.between(0.2, 0.8)};
      }
      if (kind < 0.58) add(blend.points, PointSkeleton{s.from, 0.3});
    }
  }
  return blend;
}

BlendField blend_of_skeletons(Random& random) {
  BlendField blend;
  blend.degree = random.whole(3, 8);
  blend.alpha_per_skeleton = true;
  give_kernel(blend, random);
  const auto add = [&](auto& list, const auto& skeleton, bool is_triangle) {
    list.add(skeleton, {});
    list.alphas.push_back(random.between(-0.4, 1.5));
    list.alphas_to.push_back(random.between(0, 1) < 0.5 ? list.alphas.back() : random.between(-0.4, 1.5));
    if (is_triangle) list.alphas_third.push_back(random.between(-0.4, 1.5));
  };
  for (int k = random.whole(1, 4); k > 0; --k) add(blend.segments, random.segment(), false);
  for (int k = random.whole(0, 2); k > 0; --k) add(blend.triangles, random.triangle(), true);
  for (int k = random.whole(0, 2); k > 0; --k) add(blend.arcs, random.arc(), false);
  for (int k = random.whole(-2, 2); k > 0; --k) {
    SegmentSkeleton s = random.segment();
    if (random.between(0, 1) < 0.3) s.to = lerp(s.from, s.to, 0.1);  // a steep cone
    add(blend.distance_segments, s, false);
  }
  for (int k = random.whole(-2, 1); k > 0; --k) add(blend.distance_triangles, random.triangle(), true);
  for (int k = random.whole(-2, 1); k > 0; --k) add(blend.distance_arcs, random.arc(), false);
  if (blend.kernel == KernelFamily::Inverse && blend.degree == 3 && random.between(0, 1) < 0.5)
    add(blend.cani_hornus_segments, random.segment(), false);
  if (random.between(0, 1) < 0.5) {
    blend.points.add(random.point(), {});
    blend.points.alphas.push_back(random.between(0, 1.5));
  }
  return blend;
}

bool holds(const Interval& bounds, double x, double slack) { return bounds.lo - slack <= x && x <= bounds.hi + slack; }

struct Counts {
  int sloped = 0, narrow = 0;
};

void check(const BlendField& blend, Random& random, Counts& counts) {
  const double half = pow(10, random.between(-5, -0.5));
  const Vec3d center = random.vector(2.5);
  const Vec3d direction = normalize(random.vector(1)).vec();
  const bool is_way = random.between(0, 1) < 0.5;
  const Stretch way{direction * half, direction, 1e-15};
  const Box3 box = is_way ? Box3{center, center}.padded(half) : Box3{center, center}.padded(half / std::sqrt(3.0));
  const SumBounds sum(blend, box, Wanted::Slopes, is_way ? &way : nullptr);
  const AngleBounds angle = mean_angles(blend, sum);
  const double steepest = length(alpha_at(blend, center).gradient);
  double width = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) width = std::max(width, angle.gradient[axis].width());
  counts.narrow += width < 0.5 * steepest;
  counts.sloped += width < 1e300;
  for (int k = 0; k < 8; ++k) {
    const Vec3d p = center + (is_way ? direction * random.between(-half, half) : random.vector(half / std::sqrt(3.0)));
    const AlphaSample a = alpha_at(blend, p);
    EXPECT_TRUE(holds(angle.value, a.value, 1e-12)) << a.value << " of " << angle.value.lo << " " << angle.value.hi;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_TRUE(holds(angle.gradient[axis], a.gradient[axis], 1e-9 * (1 + length(a.gradient))))
          << a.gradient[axis] << " of " << angle.gradient[axis].lo << " " << angle.gradient[axis].hi;
  }
}

TEST(MeanAngles, HoldAtPlacesOfTheBoxAndOfTheStretch) {
  Random random(64);
  for (const bool by_direction : {true, false}) {
    Counts counts;
    for (int i = 0; i < 2500; ++i) {
      check(by_direction ? blend_of_strands(random) : blend_of_skeletons(random), random, counts);
      if (::testing::Test::HasFailure()) FAIL() << "case " << i << (by_direction ? " by direction" : " by skeleton");
    }
    std::cout << "  with slopes " << counts.sloped << ", narrower than half the slope " << counts.narrow << '\n';
    EXPECT_GT(counts.sloped, 1400);
    EXPECT_GT(counts.narrow, 250);
  }
}

}  // namespace
}  // namespace marrow
