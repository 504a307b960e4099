// Laws that every lobe obeys.
#include "materials/bsdf.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/materials/random_directions.h"

namespace marrow {
namespace {

const ComplexIndex all_reflecting{Rgb(0), Rgb(1)};  // n = 0: |r| = 1 at every angle

struct Case {
  std::string name;
  Bsdf bsdf;
};

std::vector<Case> cases() {
  std::vector<Case> all{{"diffuse", Diffuse(Rgb(0.2, 0.5, 1))}};
  for (const double roughness : {0.3, 0.6, 1.0}) {
    const std::string suffix = " of roughness " + std::to_string(roughness);
    all.push_back({"gold" + suffix, Conductor(*metal("gold"), roughness)});
    all.push_back({"coated" + suffix, Coated(Rgb(0.1, 0.5, 0.9), roughness, 1.5)});
  }
  return all;
}

// Mean of `f(sample)` over well spread samples; samples that were absorbed count as nothing.
template <class F>
Rgb mean_of_samples(const Bsdf& bsdf, const UnitVec3& wo, int n, F f) {
  Rgb sum;
  for (int i = 0; i < n; ++i)
    if (const auto s = bsdf.sample(wo, spread(i))) sum += f(*s);
  return sum / n;
}

TEST(Bsdf, IsReciprocal) {
  RandomNumbers random(1);
  for (const Case& c : cases())
    for (int i = 0; i < 1000; ++i) {
      const UnitVec3 a = direction(0.01 + 0.99 * random.unit(), 6 * random.unit());
      const UnitVec3 b = direction(0.01 + 0.99 * random.unit(), 6 * random.unit());
      const Rgb ab = c.bsdf.eval(a, b) / b.z(), ba = c.bsdf.eval(b, a) / a.z();
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(ab[k], ba[k], 1e-12 * (1 + ab[k])) << c.name;
    }
}

TEST(Bsdf, SamplesCarryTheirWeightAndDensity) {
  RandomNumbers random(2);
  for (const Case& c : cases())
    for (int i = 0; i < 1000; ++i) {
      const UnitVec3 wo = direction(0.01 + 0.99 * random.unit(), 6 * random.unit());
      const auto s = c.bsdf.sample(wo, random.cube());
      if (!s) continue;
      ASSERT_GT(s->wi.z(), 0);
      ASSERT_NEAR(length(s->wi), 1, 1e-12);
      ASSERT_EQ(s->pdf, c.bsdf.pdf(wo, s->wi)) << c.name;
      ASSERT_EQ(s->weight, c.bsdf.eval(wo, s->wi) / s->pdf) << c.name;
    }
}

TEST(Bsdf, NothingScattersBelowTheSurface) {
  for (const Case& c : cases()) {
    EXPECT_FALSE(c.bsdf.sample(direction(-0.5, 0), spread(1))) << c.name;
    EXPECT_TRUE(is_black(c.bsdf.eval(direction(0.5, 0), direction(-0.5, 0)))) << c.name;
    EXPECT_TRUE(is_black(c.bsdf.eval(direction(-0.5, 0), direction(0.5, 0)))) << c.name;
    EXPECT_EQ(c.bsdf.pdf(direction(0.5, 0), direction(-0.5, 0)), 0) << c.name;
  }
}

// Mean weight over samples = reflected share. N = 65536 points of a sequence of error about log(N)^3/N.
TEST(Bsdf, ReflectsNoMoreThanItGets) {
  for (const Case& c : cases())
    for (const double mu : {0.05, 0.3, 0.7, 1.0}) {
      const Rgb share =
          mean_of_samples(c.bsdf, direction(mu, 0.4), 1 << 15, [](const BsdfSample& s) { return s.weight; });
      EXPECT_LE(max_channel(share), 1.002) << c.name << ' ' << mu;
    }
}

TEST(Bsdf, WhiteFurnaceGivesBackEverything) {
  for (const double roughness : {0.0, 0.1, 0.25, 0.5, 0.75, 1.0})
    for (const double mu : {0.1, 0.3, 0.5, 0.8, 1.0}) {
      const auto weight = [](const BsdfSample& s) { return s.weight; };
      const UnitVec3 wo = direction(mu, 0.4);
      EXPECT_NEAR(mean_of_samples(Conductor(all_reflecting, roughness), wo, 1 << 15, weight).r, 1, 2e-3)
          << "metal " << roughness << ' ' << mu;
      EXPECT_NEAR(mean_of_samples(Coated(Rgb(1), roughness, 1.5), wo, 1 << 15, weight).r, 1, 2e-3)
          << "coated " << roughness << ' ' << mu;
    }
}

// Expected counts of samples in cells of (cos theta, phi), and of absorbed ones, by midpoints of the density.
std::vector<double> expected_shares(const Bsdf& bsdf, const UnitVec3& wo, int across, int around, int fine) {
  std::vector<double> shares;
  double rest = 1;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < around; ++j) {
      double sum = 0;
      for (int a = 0; a < fine; ++a)
        for (int b = 0; b < fine; ++b)
          sum += bsdf.pdf(
              wo, direction((i + (a + 0.5) / fine) / across, 2 * std::numbers::pi * (j + (b + 0.5) / fine) / around));
      shares.push_back(sum / (fine * fine) * 2 * std::numbers::pi / (across * around));
      rest -= shares.back();
    }
  shares.push_back(std::max(rest, 0.0));
  return shares;
}

// Pearson's statistic over cells that expect at least five; rarer cells are put together.
struct ChiSquare {
  double statistic = 0;
  int degrees = -1;
};
ChiSquare chi_square(const std::vector<double>& shares, const std::vector<int>& counts, int n) {
  ChiSquare result;
  double rare_expected = 0, rare_count = 0;
  const auto add = [&](double expected, double count) {
    result.statistic += (count - expected) * (count - expected) / expected;
    ++result.degrees;
  };
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (shares[i] * n >= 5) add(shares[i] * n, counts[i]);
    else rare_expected += shares[i] * n, rare_count += counts[i];
  if (rare_expected >= 5) add(rare_expected, rare_count);
  return result;
}

// The 1 - 1e-5 quantile of chi^2 by the cube-root rule; 40 tests of fixed seed, so that a failure fails every time.
double largest_statistic(int degrees) {
  const double k = degrees, root = 1 - 2 / (9 * k) + 4.265 * std::sqrt(2 / (9 * k));
  return k * root * root * root;
}

TEST(Bsdf, SamplesFollowTheirDensity) {
  constexpr int across = 8, around = 12, fine = 64, n = 50000;
  RandomNumbers random(3);
  for (const Case& c : cases())
    for (const double mu : {0.95, 0.4, 0.1}) {
      const UnitVec3 wo = direction(mu, 0.2);
      std::vector<int> counts(across * around + 1);
      for (int i = 0; i < n; ++i) {
        const auto s = c.bsdf.sample(wo, random.cube());
        std::size_t cell = across * around;
        if (s) {
          const double phi = atan2(s->wi.y(), s->wi.x()) / (2 * std::numbers::pi);
          const int row = std::min(static_cast<int>(s->wi.z() * across), across - 1);
          const int column = std::min(static_cast<int>((phi - std::floor(phi)) * around), around - 1);
          cell = static_cast<std::size_t>(row * around + column);
        }
        ++counts[cell];
      }
      const ChiSquare chi = chi_square(expected_shares(c.bsdf, wo, across, around, fine), counts, n);
      EXPECT_LT(chi.statistic, largest_statistic(chi.degrees)) << c.name << ' ' << mu << ", degrees " << chi.degrees;
    }
}

}  // namespace
}  // namespace marrow
