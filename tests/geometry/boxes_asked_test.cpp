// Of boxes that are tiny beside the scene a ray is asked in each that it comes into, and in hardly any other.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "renderer/geometry/embree_surfaces.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

// Holds no surface, and counts how often each element was asked.
class EmptyBoxes final : public Solid {
 public:
  EmptyBoxes(std::vector<Box3> boxes, bool packets)
      : boxes_(std::move(boxes)), packets_(packets), asked_(boxes_.size(), 0) {}

  std::vector<int> take_asked() const { return std::exchange(asked_, std::vector<int>(boxes_.size(), 0)); }

  std::size_t element_count() const override { return boxes_.size(); }
  Box3 element_box(std::size_t i) const override { return boxes_[i]; }
  Box3 extent() const override { return boxes_[0]; }
  std::optional<double> hit(std::size_t i, const Ray&, bool, ElementLog&) const override {
    ++asked_[i];
    return {};
  }
  bool traces_packets() const override { return packets_; }
  void describe(std::span<const HitToDescribe>) const override {}
  std::size_t primitive_count() const override { return boxes_.size(); }
  std::size_t bytes() const override { return 0; }

 private:
  std::vector<Box3> boxes_;
  bool packets_;
  mutable std::vector<int> asked_;
};

// A block of 6 x 6 x 6 cells of size 1 around the origin, and one as large as the block's way from it.
std::vector<Box3> cells_and_one_far_away(double distance) {
  std::vector<Box3> boxes;
  for (int x = -3; x < 3; ++x)
    for (int y = -3; y < 3; ++y)
      for (int z = -3; z < 3; ++z) boxes.push_back({{x + 0.0, y + 0.0, z + 0.0}, {x + 1.0, y + 1.0, z + 1.0}});
  const Vec3d there{-2 * distance, 0, 0}, half{distance, distance, distance};
  boxes.push_back({there - half, there + half});
  return boxes;
}

bool comes_into(const Ray& ray, const Box3& box) {
  long double enter = ray.t_min, exit = ray.t_max;
  for (std::size_t k = 0; k < 3; ++k) {
    const long double d = ray.direction.vec()[k], o = ray.origin[k];
    if (d == 0) {
      if (o < box.lower[k] || o > box.upper[k]) return false;
      continue;
    }
    const long double a = (box.lower[k] - o) / d, b = (box.upper[k] - o) / d;
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return enter <= exit;
}

// Through the cells, along their faces and edges, past them, and from afar.
Ray ray_at_cells(Random& random) {
  Vec3d target = random.vector(4);
  if (random.between(0, 1) < 0.3)
    for (std::size_t k = 0; k < 3; ++k) target[k] = std::round(target[k]);
  Vec3d direction = random_direction(random);
  if (random.between(0, 1) < 0.3) direction = Vec3d{0, random.between(0, 1) < 0.5 ? 1.0 : 0.0, -1};
  const std::array distances{2.0, 20.0, 1e5};
  return {target - direction * distances[static_cast<std::size_t>(random.whole(0, 2))], normalize(direction)};
}

struct Asked {
  int in_vain = 0, entered = 0, lost = 0, twice = 0;
  void count(const Ray& ray, const EmptyBoxes& solid, std::size_t cells) {
    const std::vector<int> asked = solid.take_asked();
    for (std::size_t i = 0; i < cells; ++i) {
      const bool in = comes_into(ray, solid.element_box(i));
      entered += in;
      lost += in && asked[i] == 0;
      in_vain += !in && asked[i] > 0;
      twice += asked[i] > 1;
    }
  }
};

TEST(BoxesAsked, AreThoseThatARayComesInto) {
  for (const bool packets : {false, true}) {
    for (const double distance : {1e2, 1e6, 1e9}) {
      Random random(109);
      const auto boxes = cells_and_one_far_away(distance);
      auto own = std::make_unique<EmptyBoxes>(boxes, packets);
      const EmptyBoxes& solid = *own;
      std::vector<PlacedSolid> solids;
      solids.push_back({std::move(own), ObjectId{0}});
      const auto surfaces = EmbreeSurfaces::make(std::move(solids), {}, "threads=1");
      ASSERT_TRUE(surfaces);
      Asked asked;
      for (int i = 0; i < 2000; ++i) {
        // A stream takes three rays or more: the others begin where nothing is ahead of them.
        const Ray ray = ray_at_cells(random), none{{0, 0, 10 * distance}, UnitVec3::unchecked({0, 0, 1})};
        const std::array rays{ray, none, none, none};
        std::array<std::optional<SurfaceHit>, 4> hits;
        if (packets) (*surfaces)->first_hits(rays, hits);
        else hits[0] = (*surfaces)->first_hit(ray);
        asked.count(ray, solid, boxes.size() - 1);
      }
      std::cout << "  " << (packets ? "in a stream, " : "alone, ") << distance
                << " cells from the far box: " << asked.entered << " cells entered, asked in vain " << asked.in_vain
                << ", lost " << asked.lost << '\n';
      EXPECT_GT(asked.entered, 2000);
      EXPECT_EQ(asked.lost, 0);
      EXPECT_EQ(asked.twice, 0);
      EXPECT_LT(asked.in_vain, 0.2 * asked.entered);
    }
  }
}

}  // namespace
}  // namespace marrow::test
