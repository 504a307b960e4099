// What every operator and every warp must keep, whatever it computes: derivatives and enclosures of its own values.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "field/number/functions.h"
#include "field/number/variables_at.h"
#include "tests/field/random.h"

namespace marrow::test {

using Slope = Jet<double, 3>;
using Enclosure = Jet<Interval, 3>;

/// Fields that depend on a point: 1 + g.(p - c) below 0 cut off, as a field is.
struct Ramps {
  std::vector<Vec3d> centers, slopes;

  static Ramps random(std::size_t count, Random& random) {
    Ramps r;
    for (std::size_t i = 0; i < count; ++i) {
      r.centers.push_back({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
      r.slopes.push_back({random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
    }
    return r;
  }
  template <Number X>
  std::vector<X> at(const Vec3<X>& p) const {
    std::vector<X> f;
    for (std::size_t i = 0; i < centers.size(); ++i)
      f.push_back(max(X(1.0) + dot(p - constant<X>(centers[i]), constant<X>(slopes[i])), X(0.0)));
    return f;
  }
};

/// The operator on ramps, as a field of points.
template <class Node>
struct OnRamps {
  const Node& node;
  const Ramps& ramps;
  template <Number X>
  X operator()(const Vec3<X>& p) const {
    const std::vector<X> f = ramps.at(p);
    return node.value(std::span<const X>(f));
  }
};
/// One coordinate of where a warp looks.
template <class Node>
struct WarpCoordinate {
  const Node& node;
  std::size_t axis;
  template <Number X>
  X operator()(const Vec3<X>& p) const {
    return node.child_point(p)[axis];
  }
};

/// Values and slopes over a random box of side `size` hold the values and differences of points within.
template <class Field>
void expect_encloses(const Field& field, const Vec3d& corner, double size, Random& random) {
  Vec3<Interval> box;
  Vec3<Enclosure> variable;
  for (std::size_t i = 0; i < 3; ++i) {
    box[i] = {corner[i], corner[i] + size * random.between(0, 1)};
    variable[i] = Enclosure::variable(box[i], i);
  }
  const Interval value = field(box);
  const Enclosure jet = field(variable);
  EXPECT_LE(value.lo, value.hi);
  Vec3d last{};
  double before = 0;
  for (int k = 0; k < 6; ++k) {
    Vec3d p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = std::min(box[i].lo + random.between(0, 1) * box[i].width(), box[i].hi);
    if (k < 2)
      for (std::size_t i = 0; i < 3; ++i) p[i] = k == 0 ? box[i].lo : box[i].hi;
    const double f = field(p);
    EXPECT_TRUE(value.contains(f)) << f << " not in " << value.lo << ", " << value.hi;
    EXPECT_TRUE(jet.value.contains(f)) << f << " not in jet " << jet.value.lo << ", " << jet.value.hi;
    if (k > 0) {
      Interval change = 0;
      for (std::size_t i = 0; i < 3; ++i) change += jet.slope[i] * (Interval(p[i]) - Interval(last[i]));
      const double slack = 1e-13 * (1 + std::fabs(f));
      EXPECT_TRUE(change.lo - slack <= f - before && f - before <= change.hi + slack)
          << f - before << " not in change " << change.lo << ", " << change.hi;
    }
    last = p;
    before = f;
  }
}

/// Slopes and second derivatives at a point are those of differences; at kinks either side may be taken.
template <class Field>
void expect_derivatives(const Field& field, const Vec3d& p, double kink = 1e-3) {
  const Slope jet = field(variables_at<Slope>(p));
  const HessianJet second = field(variables_at<HessianJet>(p));
  const double value = field(p), h = 1e-5;
  EXPECT_NEAR(jet.value, value, 1e-13 * (1 + std::fabs(value)));
  EXPECT_NEAR(second.value, value, 1e-13 * (1 + std::fabs(value)));
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3d q = p, r = p;
    q[i] += h;
    r[i] -= h;
    const double ahead = (field(q) - value) / h, behind = (value - field(r)) / h;
    if (std::fabs(ahead - behind) > kink) continue;
    EXPECT_NEAR(jet.slope[i], 0.5 * (ahead + behind), kink) << "slope " << i;
    EXPECT_NEAR(second.slope[i], jet.slope[i], 1e-9 * (1 + std::fabs(jet.slope[i])));
    const Slope up = field(variables_at<Slope>(q)), down = field(variables_at<Slope>(r));
    const double a = (up.slope[i] - jet.slope[i]) / h, b = (jet.slope[i] - down.slope[i]) / h;
    if (std::fabs(a - b) > 0.05 * (1 + std::fabs(a))) continue;
    EXPECT_NEAR(second.curvature[i], 0.5 * (a + b), 0.05 * (1 + std::fabs(a))) << "curvature " << i;
  }
}

/// Both, at random points and boxes of all sizes; the seed is printed on failure.
template <class Field>
void expect_lawful(const Field& field, unsigned seed, int rounds = 300) {
  Random random(seed);
  for (int i = 0; i < rounds && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(i));
    const Vec3d p{random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)};
    expect_encloses(field, p, std::pow(10.0, random.between(-6, 0.5)), random);
    expect_derivatives(field, p);
  }
}

/// Enclosures shrink with their boxes.
template <class Field>
void expect_converges(const Field& field, Random& random) {
  for (int i = 0; i < 300; ++i) {
    const Vec3d p{random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)};
    constexpr double size = 1e-9;
    const Interval value = field(Vec3<Interval>{{p.x, p.x + size}, {p.y, p.y + size}, {p.z, p.z + size}});
    EXPECT_LE(value.width(), 1e-5) << "at " << p.x << ' ' << p.y << ' ' << p.z;
  }
}

template <class Node>
void expect_lawful_operator(const Node& node, std::size_t children, unsigned seed, int scenes = 10) {
  Random random(seed);
  for (int i = 0; i < scenes && !testing::Test::HasFailure(); ++i) {
    const Ramps ramps = Ramps::random(children, random);
    expect_lawful(OnRamps<Node>{node, ramps}, seed + static_cast<unsigned>(i));
    expect_converges(OnRamps<Node>{node, ramps}, random);
  }
  const std::vector<double> nothing(children, 0.0);
  EXPECT_EQ(node.value(std::span<const double>(nothing)), 0);
}

/// Below child_level(level) of all children, the value is below the level.
template <class Node>
void expect_child_level(const Node& node, std::size_t children, unsigned seed) {
  Random random(seed);
  for (int i = 0; i < 1000; ++i) {
    const double level = 3 * random.between(0, 1), limit = node.child_level(level, children);
    std::vector<double> f(children);
    for (double& x : f) x = limit * (i % 2 ? random.between(0, 1) : 1 - 1e-9 * random.between(0, 1));
    EXPECT_LE(node.value(std::span<const double>(f)), level) << "seed " << seed << " level " << level;
  }
}

template <class Node>
double field_of(const Node& node, const std::vector<double>& f) {
  return node.value(std::span<const double>(f));
}

}  // namespace marrow::test
