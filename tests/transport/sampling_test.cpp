// Samples are well spread and repeatable; the filter is sampled as it is.
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "renderer/transport/sampling/pixel_filter.h"
#include "renderer/transport/sampling/sobol.h"

namespace marrow {
namespace {

// Points of one 2-D pair of one pixel.
std::vector<Sample2> points(int n, int pixel, int pair) {
  Sampler sampler(pixel, 3, 11);
  std::vector<Sample2> all;
  for (int i = 0; i < n; ++i) {
    sampler.start(static_cast<std::uint32_t>(i));
    for (int skip = 0; skip < pair; ++skip) sampler.next_2d();
    all.push_back(sampler.next_2d());
  }
  return all;
}

TEST(Sobol, EveryElementaryIntervalHoldsOnePoint) {
  for (int log_n = 0; log_n <= 8; ++log_n)
    for (int pixel = 0; pixel < 8; ++pixel)
      for (int pair = 0; pair < 3; ++pair) {
        const int n = 1 << log_n;
        const std::vector<Sample2> all = points(n, pixel, pair);
        for (int log_columns = 0; log_columns <= log_n; ++log_columns) {
          std::set<std::pair<int, int>> cells;
          for (const Sample2& p : all)
            cells.emplace(static_cast<int>(p.x * (1 << log_columns)),
                          static_cast<int>(p.y * (1 << (log_n - log_columns))));
          ASSERT_EQ(cells.size(), all.size()) << log_n << ' ' << log_columns;
        }
      }
}

TEST(Sobol, OneDimensionIsStratified) {
  Sampler sampler(5, 6, 7);
  std::set<int> cells;
  for (std::uint32_t i = 0; i < 64; ++i) {
    sampler.start(i);
    cells.insert(static_cast<int>(sampler.next_1d() * 64));
  }
  EXPECT_EQ(cells.size(), 64u);
}

double variance_of_mean(int n) {
  constexpr int scrambles = 400;
  double sum = 0, squares = 0;
  for (int s = 0; s < scrambles; ++s) {
    double mean = 0;
    for (const Sample2& p : points(n, s, 0)) mean += exp(p.x + p.y) / n;
    sum += mean;
    squares += mean * mean;
  }
  return squares / scrambles - (sum / scrambles) * (sum / scrambles);
}

TEST(Sobol, VarianceOfASmoothFunctionFallsWithTheCube) {
  const double slope = (log(variance_of_mean(1024)) - log(variance_of_mean(16))) / log(64.0);
  EXPECT_LT(slope, -2.6);
  EXPECT_GT(slope, -3.4);
}

TEST(Sobol, PairsAreIndependent) {
  constexpr int n = 4096;
  const std::vector<Sample2> a = points(n, 1, 0), b = points(n, 1, 1), other = points(n, 2, 0);
  double correlation = 0, correlation_of_pixels = 0;
  for (std::size_t i = 0; i < n; ++i) {
    correlation += (a[i].x - 0.5) * (b[i].x - 0.5) * 12 / n;
    correlation_of_pixels += (a[i].x - 0.5) * (other[i].x - 0.5) * 12 / n;
  }
  EXPECT_LT(std::fabs(correlation), 4 / std::sqrt(n));
  EXPECT_LT(std::fabs(correlation_of_pixels), 4 / std::sqrt(n));
}

TEST(Sobol, IsAFunctionOfItsKeyAlone) {
  const auto third = [](int x, int y, std::uint64_t seed, std::uint32_t index) {
    Sampler s(x, y, seed);
    s.start(index);
    s.next_2d();
    s.next_1d();
    return s.next_1d();
  };
  Sampler used(3, 4, 5);
  for (std::uint32_t i = 0; i < 10; ++i) used.start(i), used.next_3d();
  used.start(9);
  used.next_3d();
  EXPECT_EQ(used.next_1d(), third(3, 4, 5, 9));
  EXPECT_NE(third(3, 4, 5, 9), third(3, 4, 6, 9));
  EXPECT_NE(third(3, 4, 5, 9), third(4, 3, 5, 9));
}

TEST(PixelFilter, OffsetsAreSymmetricGrowingAndWithinTheRadius) {
  const PixelFilter filter;
  double last = -PixelFilter::radius - 1;
  for (int i = 0; i < 1000; ++i) {
    const double u = i / 1000.0;
    const double x = filter.offset({u, 0.5}).x;
    EXPECT_GE(x, last);
    EXPECT_LE(std::fabs(x), PixelFilter::radius);
    EXPECT_NEAR(x, -filter.offset({1 - u - 1e-12, 0.5}).x, 1e-6);
    last = x;
  }
  EXPECT_NEAR(filter.offset({0.5, 0.5}).x, 0, 1e-12);
}

// A28: a step edge shows the filter's integral. Here: the share of samples left of an edge, against the window's sum.
TEST(PixelFilter, EdgeShowsTheIntegralOfTheWindow) {
  const PixelFilter filter;
  constexpr int n = 100000;
  for (const double edge : {-0.8, -0.3, 0.1, 0.6}) {
    double left = 0, part = 0, whole = 0;
    for (int i = 0; i < n; ++i) left += filter.offset({(i + 0.5) / n, 0}).x < edge;
    for (int i = 0; i < n; ++i) {
      const double x = 3.0 * (i + 0.5) / n - 1.5, phase = 2 * 3.14159265358979 * (i + 0.5) / n;
      const double w = 0.35875 - 0.48829 * cos(phase) + 0.14128 * cos(2 * phase) - 0.01168 * cos(3 * phase);
      whole += w;
      if (x < edge) part += w;
    }
    EXPECT_NEAR(left / n, part / whole, 2e-4) << edge;
  }
}

}  // namespace
}  // namespace marrow
