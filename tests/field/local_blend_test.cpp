// A blend in a part of space is the blend, to within what is certified, and its bounds hold its values and slopes.
#include "field/blend/local/local_blend.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "field/skeleton/distance.h"
#include "tests/field/random.h"
#include "tests/field/varied_blend.h"

namespace marrow {
namespace {

using test::Random;

// The rule of contact that adapts to all that the kernel allows.
std::shared_ptr<const LocalContact> adapted_contact(const BlendField& blend) {
  const bool density = blend.kernel == KernelFamily::Inverse;
  return std::make_shared<const LocalContact>(kernel_of(blend), true, Projection::Paper, true, density);
}

// All that becomes sources, under both kernels that allow it; of the compact one lines alone.
BlendField blend_of_all(Random& random, int round) {
  BlendField blend;
  blend.degree = random.whole(3, 7);
  blend.kernel = round % 3 == 2 ? KernelFamily::Cauchy : round % 7 == 5 ? KernelFamily::Compact : KernelFamily::Inverse;
  blend.kernel_shape = blend.kernel == KernelFamily::Compact ? random.between(1.2, 2) : random.between(0.5, 2);
  blend.alpha = round % 4 == 0 ? 1.5707963267948966 : random.between(0, 1.5);
  for (int i = random.whole(0, 3); i > 0; --i) blend.points.add(random.point(), {});
  for (int i = random.whole(1, 6); i > 0; --i) blend.segments.add(random.segment(), {});
  const bool adapts = round % 5 == 1;
  for (int i = round % 3 == 0 && !adapts ? random.whole(1, 9) : 0; i > 0; --i) {
    blend.distance_segments.add(random.segment(), {});
    blend.distance_segments.strands.push_back(static_cast<std::uint32_t>(i < 5));  // several of one strand
  }
  if (adapts) blend.local_contact = adapted_contact(blend);
  if (blend.kernel == KernelFamily::Compact) return blend;
  if (round % 2 == 0) blend.arcs.add(random.arc(), {});
  if (round % 5 == 0) blend.triangles.add(random.triangle(), {});
  return blend;
}

Vec3d point_in(const Box3& box, Random& random) {
  Vec3d p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = random.between(box.lower[i], box.upper[i]);
  return p;
}

// law(blend, local, box) for boxes in boxes.
template <class Law>
void for_local_blends(std::uint64_t seed, int rounds, const Law& law) {
  Random random(seed);
  for (int round = 0; round < rounds && !testing::Test::HasFailure(); ++round) {
    SCOPED_TRACE("blend " + std::to_string(round));
    const BlendField blend = blend_of_all(random, round);
    Vec3d center = random.vector(2);
    std::shared_ptr<const LocalBlend> local;
    for (double half = random.between(0.1, 0.8); half > 0.01; half *= 0.5) {
      const Box3 box = Box3{center, center}.padded(half);
      local = LocalBlend::make(blend, local, box);
      if (local) law(blend, *local, box, random);
      center = point_in(box.padded(-half / 2), random);
    }
  }
}

TEST(LocalBlend, IsTheBlendToWithinItsCertifiedError) {
  int checked = 0;
  double worst = 0;
  for_local_blends(
      20260301, 250, [&](const BlendField& blend, const LocalBlend& local, const Box3& box, Random& random) {
        const Vec3d p = point_in(box, random);
        const BlendSample exact = evaluate(blend, p);
        if (!std::isfinite(exact.corrected) || exact.corrected > 1e6) return;
        ++checked;
        EXPECT_LE(local.f_error(), LocalBlend::largest_error * (1 + 100 * static_cast<double>(blend.size())));
        const double off = std::fabs(local.value(p) - exact.corrected);
        worst = std::max(worst, off / (1 + exact.corrected));
        if (blend.alpha > 1.57 && !blend.local_contact) {
          EXPECT_LE(off, local.f_error() + 1e-10 * (1 + exact.corrected));
        }
        EXPECT_LE(off, 1e-9 * (1 + exact.corrected)) << "C " << exact.corrected;
        const LocalBlend::Sample sample = local.evaluate(p);
        EXPECT_NEAR(sample.value, local.value(p), 1e-13 * (1 + exact.corrected));
        const double steep = length(exact.corrected_gradient);
        EXPECT_LE(length(sample.gradient - exact.corrected_gradient), 1e-6 * (1e-3 + steep));
      });
  std::cout << "  " << checked << " points, largest difference " << worst << '\n';
  EXPECT_GT(checked, 500);
  EXPECT_LT(worst, 1e-10);
}

// Strands in hundreds: what is far from small boxes is no longer summed.
TEST(LocalBlend, ManyPrimitivesBecomePolynomials) {
  Random random(20261105);
  double worst = 0, most_sources = 0;
  int polynomials = 0;
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE("blend " + std::to_string(round));
    BlendField blend;
    blend.degree = random.whole(3, 8);
    if (round % 3 == 0) blend.kernel = KernelFamily::Cauchy;
    blend.alpha = random.between(0, 1.5);
    if (round % 4 == 1) blend.alpha_source = std::make_shared<test::WavingAngle>();
    if (round % 4 == 2) blend.local_contact = adapted_contact(blend);
    for (int strand = 0; strand < 120; ++strand) {
      Vec3d at = random.vector(2);
      for (int i = 0; i < 8; ++i) {
        const Vec3d next = at + random.vector(0.2);
        const double radius = random.between(0.02, 0.06);
        if (i == 7) blend.points.add({at, radius}, {});
        else blend.segments.add({at, next, radius, i % 2 == 0 ? radius : 0.5 * radius}, {});
        at = next;
      }
    }
    Vec3d center = random.vector(1.5);
    std::shared_ptr<const LocalBlend> local;
    for (double half = 2; half > 0.02; half *= 0.5) {
      const Box3 box = Box3{center, center}.padded(half);
      local = LocalBlend::make(blend, local, box);
      polynomials += local && local->has_polynomial();
      for (int i = 0; local && i < 20; ++i) {
        const Vec3d p = point_in(box, random);
        const BlendSample exact = evaluate(blend, p);
        if (!(exact.corrected < 1e3)) continue;
        const LocalBlend::Sample sample = local->evaluate(p);
        worst = std::max(worst, std::fabs(sample.value - exact.corrected) / (1 + exact.corrected));
        EXPECT_LE(std::fabs(sample.value - exact.corrected), local->f_error() + local->S_error() + 1e-10);
        EXPECT_NEAR(sample.value, local->value(p), 1e-12 * (1 + exact.corrected));
        EXPECT_LE(length(sample.gradient - exact.corrected_gradient), 1e-5 * (1 + length(exact.corrected_gradient)));
        const BlendBounds around = local->bounds(Box3{p, p}.padded(0.001 * half));
        EXPECT_LE(around.value.lo, sample.value);
        EXPECT_GE(around.value.hi, sample.value);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_LE(around.gradient[axis].lo, sample.gradient[axis]);
          EXPECT_GE(around.gradient[axis].hi, sample.gradient[axis]);
        }
      }
      center = point_in(box.padded(-half / 2), random);
    }
    EXPECT_TRUE(local->has_polynomial());
    most_sources = std::max(most_sources, static_cast<double>(local->source_count()));
  }
  std::cout << "  " << polynomials << " polynomials, off by at most " << worst << ", then at most " << most_sources
            << " sources\n";
  EXPECT_GT(polynomials, 30);
  EXPECT_LT(worst, 1e-7);
  EXPECT_LT(most_sources, 1500);
}

// The elbows of pipes: rules hold however small the circle and short the arc.
TEST(LocalBlend, ArcsOfSmallCirclesBecomeFewSources) {
  Random random(20260305);
  double worst = 0;
  std::size_t most = 0;
  for (int round = 0; round < 600; ++round) {
    BlendField blend;
    blend.degree = random.whole(3, 8);
    if (round % 3 == 0) blend.kernel = KernelFamily::Cauchy;
    ArcSkeleton arc = random.arc();
    arc.major = pow(10.0, random.between(-4, 0.3));
    arc.radius_from = arc.radius_to = 0.05;
    arc.end = arc.begin + pow(10.0, random.between(-3, 0.7));
    blend.arcs.add(arc, {});
    const Vec3d center = arc.center + random.vector(2 + arc.major);
    const double away = distance_to(arc, center);
    const Box3 box = Box3{center, center}.padded(random.between(0.1, 0.3) * away);
    const auto local = LocalBlend::make(blend, nullptr, box);
    ASSERT_TRUE(local) << "round " << round;
    const double field = evaluate(blend, center).sum;
    most = std::max(most, local->near_count() + local->source_count());
    if (!(field < 1)) continue;
    const Vec3d p = point_in(box, random);
    worst = std::max(worst, std::fabs(local->value(p) - corrected_value(blend, p)));
  }
  std::cout << "  at most " << most << " sources and parts, off by " << worst << '\n';
  EXPECT_LE(most, 200U);
  EXPECT_LE(worst, 1e-9);
}

TEST(LocalBlend, BoundsHoldValuesAndSlopes) {
  int checked = 0, with_slopes = 0;
  for_local_blends(20260302, 200, [&](const BlendField&, const LocalBlend& local, const Box3& box, Random& random) {
    Box3 part;
    part.include(point_in(box, random));
    const double share = pow(10.0, random.between(-3, 0));
    part.include(lerp(part.lower, point_in(box, random), share));
    const BlendBounds bounds = local.bounds(part);
    for (int i = 0; i < 4; ++i) {
      const Vec3d p = point_in(part, random);
      const LocalBlend::Sample sample = local.evaluate(p);
      if (!std::isfinite(sample.value)) continue;
      ++checked;
      EXPECT_TRUE(bounds.value.contains(sample.value))
          << sample.value << ' ' << bounds.value.lo << ' ' << bounds.value.hi;
      for (std::size_t k = 0; k < 3; ++k) {
        with_slopes += std::isfinite(bounds.gradient[k].width());
        const double by = 1e-9 * (1 + length(sample.gradient));
        EXPECT_GE(sample.gradient[k], bounds.gradient[k].lo - by);
        EXPECT_LE(sample.gradient[k], bounds.gradient[k].hi + by);
      }
    }
  });
  EXPECT_GT(checked, 1000);
  EXPECT_GT(with_slopes, checked / 2);
}

// A box near a skeleton, and a box around it.
TEST(LocalBlend, BoundsOfTheBlendHoldBesideAndOnSkeletons) {
  Random random(20260303);
  int above_one = 0;
  for (int round = 0; round < 400; ++round) {
    BlendField blend;
    blend.degree = random.whole(3, 6);
    blend.alpha = random.between(0, 1.5);
    const bool cauchy = round % 4 == 0;
    if (cauchy) blend.kernel = KernelFamily::Cauchy;
    const SegmentSkeleton s = random.segment();
    blend.segments.add(s, {});
    if (round % 3 == 0) blend.arcs.add(random.arc(), {});
    const Vec3d on = lerp(s.from, s.to, random.between(0, 1));
    const Box3 box = Box3{on, on}.padded(s.radius_from * pow(10.0, random.between(-2, 0)));
    const Interval bounds = blend_bounds(blend, box).value;
    above_one += bounds.lo > 1;
    for (int i = 0; i < 20; ++i) {
      const double value = corrected_value(blend, point_in(box, random));
      EXPECT_TRUE(bounds.contains(value)) << value << ' ' << bounds.lo << ' ' << bounds.hi;
    }
  }
  EXPECT_GT(above_one, 50);  // the inside of a tube can be told around its axis
}

// However much larger than its radius the skeleton is.
TEST(LocalBlend, BoundsTellTheInsideOfThinPlatesAndTubes) {
  Random random(20260306);
  constexpr int rounds = 300;
  int above_one = 0;
  for (int round = 0; round < rounds; ++round) {
    BlendField blend;
    blend.degree = random.whole(4, 9);
    const double radius = pow(10.0, random.between(-3, -1));
    const Vec3d a = random.vector(1), b = random.vector(1), c = random.vector(1);
    const double u = random.between(0.2, 0.4), v = random.between(0.2, 0.4);
    Vec3d on = lerp(a, b, u);
    if (round % 2 == 0) {
      blend.triangles.add({{a, b, c}, {radius, radius, radius}}, {});
      on = on + (c - a) * v;
    } else {
      blend.segments.add({a, b, radius, radius}, {});
    }
    const Box3 box = Box3{on, on}.padded(radius * pow(10.0, random.between(-4, -0.8)));
    const Interval bounds = blend_bounds(blend, box).value;
    above_one += bounds.lo > 1;
    for (int i = 0; i < 10; ++i) {
      const double value = corrected_value(blend, point_in(box, random));
      EXPECT_TRUE(bounds.contains(value)) << value << ' ' << bounds.lo << ' ' << bounds.hi;
    }
  }
  std::cout << "  " << above_one << " of " << rounds << " boxes are inside\n";
  EXPECT_GT(above_one, rounds * 9 / 10);
}

// The same lanes in plain doubles, in their order: no instruction set may give other bits.
TEST(SourceSums, AreTheSumsOfTheirLanesBitForBit) {
  Random random(20260304);
  for (int round = 0; round < 200; ++round) {
    const int m = random.whole(2, 9), count = random.whole(1, 40);
    SourceSums sums(m);
    std::vector<Source> sources;
    for (int i = 0; i < count; ++i) {
      sources.push_back({random.vector(2), random.between(0.1, 1), random.between(0.1, 1), random.between(0, 0.5)});
      sums.add(sources.back());
    }
    const Vec3d p = random.vector(2);
    double f[8]{}, S[8]{};
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const Source& s = sources[i];
      const Vec3d d = p - s.at;
      const double inverse = 1.0 / (d.x * d.x + d.y * d.y + d.z * d.z + s.lift_squared);
      double field = s.weight;
      for (int k = 0; k < m / 2; ++k) field *= inverse;
      if (m % 2 != 0) field *= std::sqrt(inverse);
      f[i % 8] += field;
      S[i % 8] += field * inverse * s.radius * d.x;
    }
    double total = 0, total_S = 0;
    for (int i = 0; i < 8; ++i) {
      total += f[i];
      total_S += S[i];
    }
    EXPECT_EQ(sums.value_at(p).value, total);
    EXPECT_EQ(sums.at(p).sum.value, total);
    EXPECT_EQ(sums.value_at(p).si_gradient.x, total_S * -static_cast<double>(m));
    EXPECT_LE(sums.least_within(p, 0.1), sums.value_at(p).value);
  }
}

}  // namespace
}  // namespace marrow
