// Random blends of everything that a blend can hold.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "field/blend/angle/local_contact.h"
#include "field/blend/blend_field.h"
#include "field/skeleton/second_order.h"
#include "tests/field/random.h"

namespace marrow::test {

/// An angle given as a function of the place.
class WavingAngle : public AlphaSource {
 public:
  AlphaSample at(const Vec3d& p) const override {
    const HessianJet a = second_order_at(p);
    return {.value = a.value, .gradient = gradient_of(a)};
  }
  HessianJet second_order_at(const Vec3d& p) const override {
    const Vec3<HessianJet> v = variables_at<HessianJet>(p);
    return 0.4 + 0.3 * sin(v.x * v.y + v.z);
  }
  Interval bounds(const Box3& box) const override { return 0.4 + 0.3 * sincos(phase(box)).sin; }
  Vec3<Interval> slopes(const Box3& box) const override {
    const Interval steepest = 0.3 * sincos(phase(box)).cos;
    return {steepest * side(box, 1), steepest * side(box, 0), steepest};
  }

 private:
  static Interval side(const Box3& box, std::size_t i) { return {box.lower[i], box.upper[i]}; }
  static Interval phase(const Box3& box) { return side(box, 0) * side(box, 1) + side(box, 2); }
};

template <class Fill>
void fill_all(BlendField& blend, const Fill& fill) {
  fill(blend.points), fill(blend.segments), fill(blend.distance_segments), fill(blend.cani_hornus_segments);
  fill(blend.triangles), fill(blend.distance_triangles), fill(blend.arcs), fill(blend.distance_arcs);
}

/// Rules: 0 constant, 1 per skeleton, 2 by direction, 3 local contact, 4 from a source.
inline void give_angles(BlendField& blend, Random& random, int rule) {
  if (rule == 1) {
    blend.alpha_per_skeleton = true;
    const auto fill = [&](auto& list) {
      for (std::size_t i = 0; i < list.size(); ++i) list.alphas.push_back(random.between(0.1, 1.4));
    };
    fill_all(blend, fill);
    const auto rise = [&](const auto& list, std::vector<double>& angles) {
      for (std::size_t i = 0; i < list.size(); ++i) angles.push_back(random.between(0.1, 1.4));
    };
    fill_all(blend, [&](auto& list) {
      if (static_cast<const void*>(&list) != &blend.points) rise(list, list.alphas_to);
    });
    rise(blend.triangles, blend.triangles.alphas_third);
    rise(blend.distance_triangles, blend.distance_triangles.alphas_third);
  } else if (rule == 2) {
    std::uint32_t strand = 0;
    const auto fill = [&](auto& list) {
      for (std::size_t i = 0; i < list.size(); ++i) list.strands.push_back(strand++);
    };
    fill_all(blend, fill);
    for (std::uint32_t i = 0; i < strand; ++i) blend.direction_bounds.push_back({random.between(0, 0.5), 1.3});
  } else if (rule == 3) {
    const Kernel kernel = kernel_of(blend);
    const bool density = blend.kernel == KernelFamily::Inverse;
    static const LocalContact table_of_four({KernelFamily::Inverse, 4, 1}, true, Projection::Paper, true, true);
    if (density) blend.degree = 4;
    blend.local_contact = density ? std::make_shared<const LocalContact>(table_of_four)
                                  : std::make_shared<const LocalContact>(kernel, true, Projection::Paper, false, false);
  } else if (rule == 4) {
    blend.alpha_source = std::make_shared<const WavingAngle>();
  }
}

/// Skeletons of all kinds under all kernels, projections and rules of the angle as `round` goes on; every fourth has a
/// critical point near the origin.
inline BlendField varied_blend(Random& random, int round) {
  const double alpha = random.between(0, 1) < 0.1 ? 1.5707963267948966 : random.between(round % 7 == 0 ? -0.8 : 0, 1.5);
  const Projection projection = round % 2 == 0 ? Projection::Paper : Projection::Exact;
  const bool cavity = round % 5 != 4, mirrored = round % 4 == 3;
  BlendField blend = mirrored ? mirrored_blend(random, {0, 0, 0}, random.whole(3, 7), alpha, cavity, projection)
                              : random_blend(random, random.whole(3, 7), alpha, cavity, projection);
  if (round % 3 != 0) {
    const bool is_cauchy = round % 3 == 1;
    blend.kernel = is_cauchy ? KernelFamily::Cauchy : KernelFamily::Compact;
    blend.kernel_shape = is_cauchy ? random.between(0.8, 2) : random.between(1.5, 3);
    blend.alpha = std::max(0.0, blend.alpha);
  }
  if (!mirrored) blend.arcs.add(random.arc(), {});
  if (!mirrored && round % 5 == 1) blend.distance_arcs.add(random.arc(), {});
  if (!mirrored && round % 5 == 2) blend.distance_triangles.add(random.triangle(), {});
  const int rule = round % 11 % 5;
  if (!mirrored && blend.kernel == KernelFamily::Inverse && blend.degree == 3 && rule != 3)
    blend.cani_hornus_segments.add(random.segment(), {});
  if (!mirrored) give_angles(blend, random, rule);
  return blend;
}

}  // namespace marrow::test
