// What is proved of ways is so, and nearly all ways that are free are proved to be.
#include "tests/stress/way_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/stress/odd_drafts.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

Setting random_setting(Random& random) {
  Setting s{random.whole(3, 8), random.between(-0.7, 1.55), true};
  if (s.alpha > 0.3 && random.between(0, 1) < 0.3) s.cavity = false;
  if (s.alpha > 0 && random.between(0, 1) < 0.3) s.projection = Projection::Exact;
  return s;
}

struct Way {
  Ray ray;
  double end;
};

Way random_way(Random& random) {
  const Vec3d from = random_direction(random) * random.between(0.2, 6), to = random.vector(1.5);
  return {{from, normalize(to - from)}, random.between(0.1, 1.5) * length(to - from)};
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), largest = 0;
};

Range sampled(const BlendField& blend, const Way& way, double begin) {
  constexpr int count = 400;
  Range range;
  for (int i = 0; i <= count; ++i) {
    const double c = corrected_value(blend, way.ray.at(begin + (way.end - begin) * i / count));
    range.least = std::min(range.least, c);
    range.largest = std::max(range.largest, c);
  }
  return range;
}

template <class Draw>
void expect_only_what_is_so(Random& random, int scenes, const Draw& draw) {
  int outside = 0, near = 0, inside = 0, ways = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    const BlendField blend = draw();
    for (int i = 0; i < 12; ++i) {
      const Way way = random_way(random);
      const auto [least, largest] = sampled(blend, way, 1e-5);
      if (!(largest < 50)) continue;  // through a skeleton
      // Below 0 the operator is largest at an end of an interval of f where it is about 1, not where it is tiny.
      if (blend.alpha < 0 && largest < 0.3) continue;
      ++ways;
      // A level that the way just reaches, or just does not keep above.
      const WayProof touched(blend, largest * (1 - 1e-9), least * (1 + 1e-9));
      EXPECT_FALSE(touched.is_outside(way.ray, 0, way.end, nullptr)) << "up to " << largest;
      EXPECT_FALSE(touched.is_inside(way.ray, 0, way.end)) << "down to " << least;
      const WayProof beside(blend, largest * 1.01, least * 0.99);
      outside += beside.is_outside(way.ray, 0, way.end, nullptr);
      inside += beside.is_inside(way.ray, 0, way.end);
      near += WayProof(blend, largest * 1.0001, least).is_outside(way.ray, 0, way.end, nullptr);
    }
  }
  std::cout << "  " << ways << " ways; proved 1 % beside their largest value " << outside << ", 0.01 % beside it "
            << near << ", 1 % beside their least " << inside << '\n';
  EXPECT_GT(outside, ways * 8 / 10);
  EXPECT_GT(near, ways * 6 / 10);
  EXPECT_GT(inside, ways / 4);
}

TEST(WayProof, HoldsOnlyWhatIsSoOfRandomScenes) {
  Random random(71);
  expect_only_what_is_so(random, 200, [&] { return random_scene(random, random_setting(random), random.whole(1, 8)); });
}

TEST(WayProof, HoldsOnlyWhatIsSoOfOddScenes) {
  Random random(72);
  std::size_t kind = 0;
  expect_only_what_is_so(random, 60, [&] { return odd_blend(kind++ % odd_kind_count, random); });
}

}  // namespace
}  // namespace marrow::test
