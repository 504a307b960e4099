// Bounds of blends whose angle varies, over boxes, against the field at points in them.
#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/angle/local_contact.h"
#include "field/blend/bounds/angle/alpha_bounds.h"
#include "field/blend/bounds/blend_bounds.h"
#include "field/program/contact_angles.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

constexpr int rules = 7;

void add_skeletons(BlendField& blend, Random& random) {
  for (int i = random.whole(2, 4); i > 0; --i) {
    if (random.between(0, 1) < 0.5) blend.points.add(random.point(), {});
    else blend.segments.add(random.segment(), {});
  }
}

// Some below 0, where the projection onto the curve itself is not defined.
double random_angle(const BlendField& blend, Random& random) {
  const double angle = random.between(0, 1.5);
  return blend.projection == Projection::Paper && random.between(0, 1) < 0.2 ? angle / 1.5 - 1 : angle;
}

void add_angles(BlendField& blend, Random& random) {
  const auto add = [&](std::vector<double>& angles) { angles.push_back(random_angle(blend, random)); };
  for (std::size_t i = 0; i < blend.points.size(); ++i) add(blend.points.alphas);
  for (std::size_t i = 0; i < blend.segments.size(); ++i) {
    add(blend.segments.alphas);
    add(blend.segments.alphas_to);
  }
}

// Each segment a strand, or all of them one.
void add_strands(BlendField& blend, Random& random) {
  const bool one = random.between(0, 1) < 0.3;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < blend.points.size(); ++i) blend.points.strands.push_back(next++);
  for (std::size_t i = 0; i < blend.segments.size(); ++i) blend.segments.strands.push_back(one ? next : next++);
  for (std::uint32_t i = 0; i <= next; ++i)
    blend.direction_bounds.push_back({random_angle(blend, random), random_angle(blend, random)});
}

class Ramp final : public AlphaSource {
 public:
  AlphaSample at(const Vec3d& p) const override { return {0.7 + 0.1 * p.x, {0.1, 0, 0}}; }
  HessianJet second_order_at(const Vec3d& p) const override { return 0.7 + 0.1 * HessianJet::variable(p.x, 0); }
  Interval bounds(const Box3& b) const override { return {0.7 + 0.1 * b.lower.x - 1e-9, 0.7 + 0.1 * b.upper.x + 1e-9}; }
  Vec3<Interval> slopes(const Box3&) const override { return {Interval(0.1), Interval(0), Interval(0)}; }
};

// Adapted to radii, under kernels whose fields have no logarithms, or have them with a lift.
void add_bounded_kernel(BlendField& blend, Random& random) {
  static const Kernel kernels[] = {{KernelFamily::Compact, 4, 1.5},
                                   {KernelFamily::Compact, 5, 2},  // the table would go beyond pi/2
                                   {KernelFamily::Cauchy, 5, 1.3}};
  const Kernel& kernel = kernels[random.whole(0, 2)];
  blend.kernel = kernel.family;
  blend.degree = kernel.degree;
  blend.kernel_shape = kernel.shape;
  static ContactAngles rules_so_far;
  Blend described;
  described.kernel = kernel;
  described.projection = blend.projection;
  blend.local_contact = rules_so_far.local(described, {.radii = true, .density = false});
  blend.alpha = blend.local_contact->contact();
}

// Two polylines by distance: of each only the segment that is the largest counts.
void add_polylines(BlendField& blend, Random& random) {
  for (std::uint32_t strand = 0; strand < 2; ++strand) {
    SegmentSkeleton s = random.segment();
    for (int i = 0; i < 3; ++i) {
      blend.distance_segments.add(s, {});
      blend.distance_segments.strands.push_back(strand);
      s = {s.to, random.vector(1.5), s.radius_to, random.between(0.2, 0.8)};
    }
  }
}

BlendField varying_blend(Random& random, int rule) {
  BlendField blend;
  blend.projection = random.between(0, 1) < 0.3 ? Projection::Exact : Projection::Paper;
  if (rule == 6) add_polylines(blend, random);
  else add_skeletons(blend, random);
  if (rule == 0) {
    blend.alpha_per_skeleton = true;
    add_angles(blend, random);
  } else if (rule == 1) {
    add_strands(blend, random);
  } else if (rule == 2) {
    blend.alpha_source = std::make_shared<const Ramp>();
  } else if (rule == 5) {
    add_bounded_kernel(blend, random);
  } else {
    static const LocalContact radii[] = {{Kernel{}, true, Projection::Paper, true, false},
                                         {Kernel{}, true, Projection::Exact, true, false}};
    static const LocalContact both[] = {{Kernel{}, true, Projection::Paper, true, true},
                                        {Kernel{}, true, Projection::Exact, true, true}};
    const auto& list = rule == 3 ? radii : both;
    blend.local_contact = std::make_shared<const LocalContact>(list[blend.projection == Projection::Exact ? 1 : 0]);
    blend.alpha = blend.local_contact->contact();
  }
  return blend;
}

bool contains(const Interval& bounds, double x, double slack) {
  return bounds.lo - slack <= x && x <= bounds.hi + slack;
}

// Returns how many slopes were bounded.
int check_point(const BlendField& blend, const BlendBounds& bounds, const AngleBounds& angle, const Vec3d& p) {
  const BlendSample s = evaluate(blend, p);
  EXPECT_TRUE(contains(angle.value, s.alpha, 1e-12)) << s.alpha << " of " << angle.value.lo << " " << angle.value.hi;
  EXPECT_TRUE(bounds.value.contains(s.corrected)) << s.corrected << " of " << bounds.value.lo << " " << bounds.value.hi;
  const AlphaSample a = alpha_at(blend, p);
  int sloped = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (s.sum > 1e50) continue;
    const double of_angle = a.gradient[axis], of_field = s.corrected_gradient[axis];
    EXPECT_TRUE(contains(angle.gradient[axis], of_angle, 1e-8 * (1 + length(a.gradient))))
        << of_angle << " of " << angle.gradient[axis].lo << " " << angle.gradient[axis].hi;
    EXPECT_TRUE(contains(bounds.gradient[axis], of_field, 1e-8 * (1 + length(s.corrected_gradient))))
        << of_field << " of " << bounds.gradient[axis].lo << " " << bounds.gradient[axis].hi;
    sloped += bounds.gradient[axis].width() < 1e300;
  }
  return sloped;
}

TEST(VaryingBounds, HoldAtPointsOfTheBox) {
  Random random(61);
  for (int rule = 0; rule < rules; ++rule) {
    int bounded = 0, sloped = 0;
    for (int i = 0; i < 1500; ++i) {
      const BlendField blend = varying_blend(random, rule);
      const Vec3d center = random.vector(2.5);
      const double half = pow(10, random.between(-5, -0.5));
      const Box3 box = Box3{center, center}.padded(half);
      const BlendBounds bounds = blend_bounds(blend, box);
      const AngleBounds angle = alpha_bounds(blend, SumBounds(blend, box), box);
      bounded += bounds.value.hi < 1e300;
      for (int k = 0; k < 6; ++k)
        sloped += check_point(blend, bounds, angle, k == 0 ? box.upper : center + random.vector(half));
      if (::testing::Test::HasFailure()) FAIL() << "rule " << rule << " case " << i << " of half size " << half;
    }
    std::cout << "  rule " << rule << ": " << bounded << " bounded, " << sloped << " slopes bounded\n";
    EXPECT_GT(bounded, 800) << rule;
    EXPECT_GT(sloped, 5000) << rule;
  }
}

TEST(VaryingBounds, NarrowWithTheBox) {
  Random random(62);
  for (int rule = 0; rule < rules; ++rule)
    for (int i = 0; i < 40; ++i) {
      const BlendField blend = varying_blend(random, rule);
      // By distance second derivatives are not known, nor anything where segments take over from each other.
      if (rule == 6) continue;
      // Of a strand that turns by more than a right angle nothing is known.
      const auto& strands = blend.segments.strands;
      if (std::adjacent_find(strands.begin(), strands.end()) != strands.end()) continue;
      const Vec3d p = normalize(random.vector(1)) * (rule == 5 ? 1.5 : 4.5);
      if (!(evaluate(blend, p).sum > 0)) continue;
      const auto bounds = [&](double half) {
        const Box3 box = Box3{p, p}.padded(half);
        return alpha_bounds(blend, SumBounds(blend, box), box);
      };
      const AngleBounds near = bounds(1e-4), far = bounds(1e-3);
      EXPECT_LT(near.value.width(), 0.2 * far.value.width() + 1e-6) << rule;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LT(near.gradient[k].width(), 0.2 * far.gradient[k].width() + 1e-6) << rule;
    }
}

}  // namespace
}  // namespace marrow
