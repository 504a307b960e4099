// Blends of a few random points and segments, as the laws of tracing want them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "field/blend/angle/contact.h"
#include "tests/field/random.h"

namespace marrow::test {

/// A blend's setting: what the laws are held for.
struct Setting {
  int degree = 4;
  double alpha = 0;
  bool cavity = true;
  Projection projection = Projection::Paper;
};

inline std::string name_of(const Setting& s) {
  std::ostringstream out;
  out << "n=" << s.degree << " alpha=" << std::setprecision(4) << s.alpha << (s.cavity ? "" : " no cavity")
      << (s.projection == Projection::Exact ? " exact" : "");
  return out.str();
}

inline Vec3d random_direction(Random& random) {
  for (;;) {
    const Vec3d v = random.vector(1);
    const double l = length(v);
    if (l > 0.05 && l <= 1) return v / l;
  }
}

inline Vec3d random_in(Random& random, const Box3& box) {
  const double x = random.between(box.lower.x, box.upper.x), y = random.between(box.lower.y, box.upper.y);
  return {x, y, random.between(box.lower.z, box.upper.z)};
}

/// `count` skeletons within 1.5 of the origin: a third are points, one in three continues the one before it as a
/// joint, radii from 0.1 to 0.5, tapered or not.
inline BlendField random_scene(Random& random, const Setting& setting, int count) {
  BlendField blend;
  blend.degree = setting.degree;
  blend.alpha = setting.alpha;
  blend.cavity = setting.cavity;
  blend.projection = setting.projection;
  for (int i = 0; i < count; ++i) {
    if (i % 3 == 2) {
      const Vec3d at = random.vector(1.5);
      blend.points.add({at, random.between(0.15, 0.5)}, {});
      continue;
    }
    SegmentSkeleton s{.from = random.vector(1.5), .to = random.vector(1.5)};
    s.radius_from = random.between(0.1, 0.4);
    if (i % 3 == 1) {
      s.from = blend.segments.skeletons.back().to;
      s.radius_from = blend.segments.skeletons.back().radius_to;
    }
    s.radius_to = random.between(0, 1) < 0.4 ? s.radius_from : random.between(0.1, 0.4);
    blend.segments.add(s, {});
  }
  return blend;
}

/// The same with an angle for each skeleton, one in three the sum.
inline BlendField random_angled_scene(Random& random, const Setting& setting, int count) {
  BlendField blend = random_scene(random, setting, count);
  blend.alpha_per_skeleton = true;
  const auto turn = [&](auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      list.alphas.push_back(random.between(0, 1) < 0.3 ? std::numbers::pi / 2 : random.between(0, 1.5));
  };
  turn(blend.points);
  turn(blend.segments);
  return blend;
}

/// Makes the angles of segments linear along them; a point keeps its one.
inline BlendField with_linear_angles(BlendField blend, Random& random) {
  blend.points.alphas_to = blend.points.alphas;
  for (const double alpha : blend.segments.alphas)
    blend.segments.alphas_to.push_back(random.between(0, 1) < 0.2 ? alpha : random.between(0, 1.5));
  return blend;
}

/// `count` strands, and a third as many points, whose directions give the angle: up to four segments that turn by
/// half a radian, of radii from 0.1 to 0.3.
inline BlendField random_stranded_scene(Random& random, const Setting& setting, int count) {
  BlendField blend = random_scene(random, setting, 0);
  const DirectionBounds bounds{random.between(0, 0.9), random.between(1, std::numbers::pi / 2)};
  for (int k = 0; k < count; ++k) {
    const auto strand = static_cast<std::uint32_t>(blend.direction_bounds.size());
    blend.direction_bounds.push_back(bounds);
    if (k % 4 == 3) {
      blend.points.add({random.vector(1.5), random.between(0.15, 0.5)}, {});
      blend.points.strands.push_back(strand);
      continue;
    }
    SegmentSkeleton s{.from = random.vector(1.2), .to = {}};
    Vec3d along = random_direction(random);
    s.radius_from = random.between(0.1, 0.3);
    for (int i = 0; i < 1 + k % 4; ++i) {
      s.to = s.from + along * random.between(0.3, 0.9);
      s.radius_to = random.between(0.1, 0.3);
      blend.segments.add(s, {});
      blend.segments.strands.push_back(strand);
      s.from = s.to;
      s.radius_from = s.radius_to;
      along = normalize(along + random_direction(random) * 0.5).vec();
    }
  }
  return blend;
}

/// Gives each strand bounds of its own, some of them larger where it crosses others.
inline BlendField with_own_bounds(BlendField blend, Random& random) {
  for (DirectionBounds& b : blend.direction_bounds) {
    b = {random.between(0, 0.9), random.between(0.6, std::numbers::pi / 2)};
    if (random.between(0, 1) < 0.2) std::swap(b.least, b.most);
  }
  return blend;
}

/// The least angle of a range that the tracer of blends takes.
inline constexpr double least_traced_angle = -0.8;

/// A third of the angles, or of the bounds of strands, below 0, down to the least that may be; the paper's projection.
inline BlendField with_angles_below_zero(BlendField blend, Random& random) {
  blend.projection = Projection::Paper;
  const auto turn = [&](double& alpha) {
    if (random.between(0, 1) < 0.33) alpha = random.between(least_traced_angle, 0);
  };
  for (auto* list : {&blend.points.alphas, &blend.segments.alphas, &blend.segments.alphas_to})
    std::ranges::for_each(*list, turn);
  if (!blend.points.alphas_to.empty()) blend.points.alphas_to = blend.points.alphas;
  auto& bounds = blend.direction_bounds;
  const bool are_equal = std::ranges::adjacent_find(bounds, std::ranges::not_equal_to{}) == bounds.end();
  for (DirectionBounds& b : bounds) {
    turn(b.least);
    turn(b.most);
  }
  if (are_equal && !bounds.empty()) bounds.assign(bounds.size(), bounds.front());
  return blend;
}

/// The angles at which rays are tested.
inline std::array<double, 4> traced_angles(int degree, bool cavity) {
  return {0, contact_alpha(degree, cavity), std::numbers::pi / 2, -0.4};
}

}  // namespace marrow::test
