// Skeletons, kernels and the operator against their definitions in 40 digits (MPFR).
#include "tests/field/oracle.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>

#include <boost/multiprecision/mpfr.hpp>
#include <gtest/gtest.h>

#include "field/blend/angle/contact.h"
#include "field/blend/correction/correction.h"
#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/second_order.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/oracle_operator.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;
using Real =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<40, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;
using Oracle = test::oracle::Sums<Real>;

double rounded(const Real& x) { return static_cast<double>(x); }
double error_of(double value, const Real& exact) {
  return exact == 0 ? std::fabs(value) : std::fabs(rounded((Real(value) - exact) / exact));
}
double error_of(const Vec3d& value, const Vec3<Real>& exact) {
  const Vec3<Real> off = test::oracle::vector_of<Real>(value) - exact;
  const Real size = test::oracle::size_of(exact);
  return size == 0 ? length(value) : rounded(test::oracle::size_of(off) / size);
}

template <class Skeleton>
SkeletonSample sample_of(const Skeleton& s, const Vec3d& p, const Kernel& kernel) {
  constexpr auto first = Derivatives::First;
  const bool inverse = kernel.family == KernelFamily::Inverse;
  if constexpr (std::same_as<Skeleton, PointSkeleton>)
    return inverse ? point_field<first>(s, p, kernel.degree) : point_field<first>(s, p, kernel);
  else if constexpr (std::same_as<Skeleton, SegmentSkeleton>)
    return inverse ? segment_field<first>(s, p, kernel.degree) : segment_field<first>(s, p, kernel);
  else if constexpr (std::same_as<Skeleton, TriangleSkeleton>)
    return inverse ? triangle_field<first>(s, p, kernel.degree) : triangle_field<first>(s, p, kernel);
  else return inverse ? arc_field<first>(s, p, kernel.degree) : arc_field<first>(s, p, kernel);
}

// Anywhere near, beyond a tip almost on the axis, close to the skeleton, and 10^4 away.
struct Place {
  std::string name;
  Vec3d at;
};
Place place_of(Random& random, const Vec3d& tip, const Vec3d& outward, int i) {
  const Vec3d aside = normalize(cross(outward, random.vector(1))).vec();
  switch (i % 4) {
    case 1:
      return {"beyond the tip",
              tip + outward * pow(10.0, random.between(-1, 1)) + aside * pow(10.0, random.between(-9, -2))};
    case 2:
      return {"beside the tip", tip + aside * pow(10.0, random.between(-2, 0)) - outward * random.between(0, 0.3)};
    case 3:
      return {"far away", normalize(random.vector(1)).vec() * 1e4};
    default:
      return {"around", random.vector(2)};
  }
}
Kernel kernel_of(Random& random, KernelFamily family, int highest_degree) {
  const int degree = random.whole(3, highest_degree);
  if (family == KernelFamily::Cauchy) return {family, degree, random.between(0.5, 2)};
  if (family == KernelFamily::Compact) return {family, degree, random.between(1.3, 4)};
  return {family, degree, 1};
}

class Worst {
 public:
  void add(const std::string& name, double error) { worst_[name] = std::max(worst_[name], error); }
  ~Worst() {
    for (const auto& [name, error] : worst_) std::cout << "  " << name << ": worst relative error " << error << '\n';
  }

 private:
  std::map<std::string, double> worst_;
};

constexpr KernelFamily families[] = {KernelFamily::Inverse, KernelFamily::Cauchy, KernelFamily::Compact};
constexpr const char* names[] = {"inverse", "cauchy", "compact"};

template <class Make>
void expect_exact(const std::string& what, std::uint64_t seed, int rounds, double tolerance, double compact_tolerance,
                  const Make& make) {
  Random random(seed);
  Worst worst;
  int checked = 0;
  for (int i = 0; i < rounds; ++i)
    for (std::size_t f = 0; f < 3; ++f) {
      const auto [skeleton, tip, outward] = make(random);
      const Place place = place_of(random, tip, outward, i);
      const Kernel kernel = kernel_of(random, families[f], 9);
      const Oracle exact = test::oracle::field<Real>(skeleton, place.at, kernel);
      if (exact.value > 1e6) continue;
      const SkeletonSample s = sample_of(skeleton, place.at, kernel);
      SCOPED_TRACE(what + " " + std::string(names[f]) + " " + place.name + ", round " + std::to_string(i) +
                   ", degree " + std::to_string(kernel.degree) + ", field " + std::to_string(s.value));
      const double error = std::max(
          {error_of(s.value, exact.value), error_of(s.gradient, exact.gradient), error_of(s.si_gradient, exact.si)});
      const bool is_tiny = families[f] == KernelFamily::Compact && exact.value < 1e-6;  // at the edge of the support
      if (!is_tiny) {
        // far from a segment places along its line are of the size of the distance and lose 4 digits
        const double exactness = place.name == "far away" && what == "segment" ? 5e-12 : tolerance;
        EXPECT_LE(error, families[f] == KernelFamily::Compact ? compact_tolerance : exactness);
        worst.add(what + " " + names[f] + " " + place.name, error);
      }
      ++checked;
    }
  EXPECT_GT(checked, rounds);
}

template <class Skeleton>
struct Scene {
  Skeleton skeleton;
  Vec3d tip, outward;
};

TEST(Oracle, Points) {
  expect_exact("point", 801, 100, 1e-14, 1e-13, [](Random& random) {
    const PointSkeleton s = random.point();
    return Scene<PointSkeleton>{s, s.at, normalize(random.vector(1)).vec()};
  });
}
TEST(Oracle, Segments) {
  expect_exact("segment", 802, 120, 1e-13, 1e-12, [](Random& random) {
    const SegmentSkeleton s = random.segment();
    return Scene<SegmentSkeleton>{s, s.to, normalize(s.to - s.from).vec()};
  });
}

// A radius that grows by 1/R of the length, or 1e-16 to 0.1 of that more or less: then one of the ends of the support
// is far away, or there is only one. Skeletons down to a thousandth of their radius, too, which the support holds
// whole.
struct SteepRadius {
  double length, from, to;

  SteepRadius(Random& random, double R, int i) {
    const double off = i % 5 == 0 ? 0 : pow(10.0, random.between(-16, -1));
    from = random.between(0.1, 0.8);
    length = i % 4 == 0 ? from * pow(10.0, random.between(-3, 0)) : random.between(0.3, 2);
    to = from + length / R * (i % 2 == 0 ? 1 + off : 1 - off);
    if (i % 3 == 0) std::swap(from, to);
  }
};
template <class Skeleton>
double error_under_compact_kernel(const Skeleton& s, const Vec3d& p, const Kernel& kernel, int& checked) {
  const Oracle exact = test::oracle::field<Real>(s, p, kernel);
  if (exact.value < 1e-6 * std::min(1.0, measure(s) / least_radius(s))) return 0;
  const SkeletonSample sample = sample_of(s, p, kernel);
  ++checked;
  return error_of(sample.value, exact.value) + error_of(sample.gradient, exact.gradient) +
         error_of(sample.si_gradient, exact.si);  // not the largest: what is not a number must stay
}
std::string told_of(int round, const Kernel& kernel) {
  return "round " + std::to_string(round) + ", degree " + std::to_string(kernel.degree) + ", support " +
         std::to_string(kernel.shape);
}
// Of numbers with derivatives against samples.
double derivatives_off(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  const SkeletonSample sample = segment_field<Derivatives::Second>(s, p, kernel);
  const SecondOrderSample moving = second_order(s, p, kernel);
  double off = length(gradient_of(moving.field) - sample.gradient) / length(sample.gradient), size = 0, rows = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    rows += length(gradient_of(moving.si[i]) - sample.si_jacobian.rows[i]);
    size += length(sample.si_jacobian.rows[i]);
  }
  return off + rows / size;
}
TEST(Oracle, SegmentsWhoseRadiusGrowsAsFastAsTheSupport) {
  Random random(807);
  Worst worst;
  int checked = 0;
  for (int i = 0; i < 240; ++i) {
    const Kernel kernel = kernel_of(random, KernelFamily::Compact, 9);
    const auto [length, from, to] = SteepRadius(random, kernel.shape, i);
    const Vec3d begin = random.vector(0.5), u = normalize(random.vector(1)).vec();
    const SegmentSkeleton s{begin, begin + u * length, from, to};
    const Vec3d aside = normalize(cross(u, random.vector(1))).vec();
    const Vec3d p = begin + u * random.between(-0.5, length + 0.5) + aside * (to * kernel.shape * random.between(0, 1));
    const double error = error_under_compact_kernel(s, p, kernel, checked);
    SCOPED_TRACE(told_of(i, kernel));
    EXPECT_LE(error, 1e-12);
    worst.add("steep segment", error);
    if (error == 0) continue;
    const double off = derivatives_off(s, p, kernel);
    EXPECT_LE(off, 1e-8);
    worst.add("derivatives of steep segments", off);
  }
  EXPECT_GT(checked, 120);
}
TEST(Oracle, TrianglesWhoseRadiusGrowsAsFastAsTheSupport) {
  Random random(808);
  Worst worst;
  int checked = 0;
  for (int i = 0; i < 30; ++i) {
    const Kernel kernel = kernel_of(random, KernelFamily::Compact, 7);
    const auto [length, from, to] = SteepRadius(random, kernel.shape, i % 4 == 0 ? i + 1 : i);  // none of the tiny ones
    const TriangleSkeleton s{{Vec3d{0, 0, 0}, Vec3d{length, 0, 0}, Vec3d{random.between(0, length), 1, 0}},
                             {from, to, i % 2 == 0 ? from : random.between(0.1, 0.8)}};
    const Vec3d p{random.between(-0.2, length + 0.2), random.between(-0.2, 0.8), random.between(0, 1) * to};
    const double error = error_under_compact_kernel(s, p, kernel, checked);
    EXPECT_LE(error, 1e-12) << told_of(i, kernel);
    worst.add("steep triangle", error);
  }
  EXPECT_GT(checked, 15);
}
TEST(Oracle, Arcs) {
  expect_exact("arc", 803, 60, 2e-13, 1e-12, [](Random& random) {
    const ArcSkeleton s = random.arc();
    const auto [sine, cosine] = sincos(s.end);
    return Scene<ArcSkeleton>{s, s.center + (s.axis1 * cosine + s.axis2 * sine) * s.major,
                              s.axis2 * cosine - s.axis1 * sine};
  });
}
TEST(Oracle, Triangles) {
  Random random(804);
  Worst worst;
  for (int i = 0; i < 16; ++i) {
    const TriangleSkeleton s = random.triangle();
    const Kernel kernel = kernel_of(random, families[i % 2], 7);
    const Vec3d outward = normalize(s.vertices[0] - (s.vertices[1] + s.vertices[2]) / 2).vec();
    const Vec3d aside = normalize(cross(outward, random.vector(1))).vec();
    const bool is_far = i % 4 == 3;
    const Vec3d p = is_far ? random.vector(1e4)
                           : s.vertices[0] + outward * random.between(0.1, 1) + aside * random.between(-0.5, 0.5);
    const Oracle exact = test::oracle::field<Real>(s, p, kernel);
    const SkeletonSample sample = sample_of(s, p, kernel);
    const double error = std::max({error_of(sample.value, exact.value), error_of(sample.gradient, exact.gradient),
                                   error_of(sample.si_gradient, exact.si)});
    EXPECT_LE(error, 1e-12) << i;
    worst.add(std::string("triangle ") + names[i % 2] + (is_far ? " far away" : ""), error);
  }
}

// The edge of the support cuts the triangle anywhere: through it, around it, at a vertex.
TEST(Oracle, TrianglesUnderTheCompactKernel) {
  Random random(806);
  Worst worst;
  int checked = 0;
  for (int i = 0; i < 40; ++i) {
    const TriangleSkeleton s = random.triangle();
    const Kernel kernel = kernel_of(random, KernelFamily::Compact, 7);
    const Vec3d normal = normalize(cross(s.vertices[1] - s.vertices[0], s.vertices[2] - s.vertices[0])).vec();
    const double x = random.between(-0.3, 1.2), y = random.between(-0.3, 1.2);
    const Vec3d p = s.vertices[0] + (s.vertices[1] - s.vertices[0]) * x + (s.vertices[2] - s.vertices[0]) * y +
                    normal * (s.radii[0] * random.between(0, 1.2));
    const Oracle exact = test::oracle::field<Real>(s, p, kernel);
    if (exact.value < 1e-6) continue;  // at the edge of the support, or outside
    const SkeletonSample sample = sample_of(s, p, kernel);
    const double error = std::max({error_of(sample.value, exact.value), error_of(sample.gradient, exact.gradient),
                                   error_of(sample.si_gradient, exact.si)});
    EXPECT_LE(error, 1e-12) << told_of(i, kernel);
    worst.add("triangle compact", error);
    ++checked;
  }
  EXPECT_GT(checked, 15);
}

TEST(Oracle, Operator) {
  Random random(805);
  Worst worst;
  for (int i = 0; i < 1500; ++i) {
    const int n = random.whole(3, 20);
    const double alpha = random.between(0.01, 1.55), f = pow(10.0, random.between(-3, 1));
    const double g = (n - 1) * pow(f, n / (n - 1.0));
    const double G = i % 5 == 0 ? g * (1 + pow(10.0, random.between(-9, -3))) : g * random.between(0.001, 2);
    const bool cavity = i % 2, exact = i % 3 == 0;
    const Real expected = test::oracle::Operator<Real>(n, Real(alpha), cavity, exact).value(Real(f), Real(G));
    const double value = Correction(n, alpha, cavity, exact ? Projection::Exact : Projection::Paper).value(f, G);
    EXPECT_LE(error_of(value, expected), 1e-13) << "n " << n << " alpha " << alpha << " f " << f << " G " << G;
    worst.add(std::string("operator ") + (exact ? "exact" : "eq. 12") + (cavity ? " with cavity" : ""),
              error_of(value, expected));
  }
}

// The angle at which C = 1 between two touching skeletons, f = 2 and G = 0, by halving the oracle's operator.
TEST(Oracle, ContactAngles) {
  for (int n = 3; n <= 20; ++n)
    for (const bool exact : {false, true}) {
      Real low = 0, high = test::oracle::pi<Real>() / 2;
      for (int step = 0; step < 110; ++step) {
        const Real middle = (low + high) / 2;
        // the limit of G to 0, where the formulas of the oracle are 0 / 0
        const Real value = test::oracle::Operator<Real>(n, middle, true, exact).value(Real(2), Real("1e-25"));
        (value < 1 ? low : high) = middle;
      }
      EXPECT_NEAR(contact_alpha(n, true, exact ? Projection::Exact : Projection::Paper), rounded(low), 2e-14) << n;
    }
}

}  // namespace
}  // namespace marrow
