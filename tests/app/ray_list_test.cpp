// Rays are read as they are written, and lengths are those of their directions.
#include "renderer/app/input/ray_list.h"

#include <sstream>

#include <gtest/gtest.h>

namespace marrow {
namespace {

Result<std::vector<ListedRay>> read(const std::string& text) {
  std::istringstream in(text);
  SourceCache sources;
  return read_rays(in, "rays", sources);
}

TEST(RayList, HasARangeOrNone) {
  const auto found = read("# rays\n1 2 3 0 3 4\n\n1 2 3 0 3 4 0.5 2\n1 2 3 0 3 4 0 inf\n");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 3u);
  for (const ListedRay& ray : *found) {
    EXPECT_EQ(ray.origin, (Vec3d{1, 2, 3}));
    EXPECT_EQ(ray.direction, (Vec3d{0, 3, 4}));
    EXPECT_EQ(ray.unit(), 5);
    EXPECT_EQ(ray.ray().direction.vec(), (Vec3d{0, 0.6, 0.8}));
  }
  EXPECT_DOUBLE_EQ((*found)[1].ray().t_min, 2.5);
  EXPECT_DOUBLE_EQ((*found)[1].ray().t_max, 10);
  for (const std::size_t endless : {0u, 2u}) EXPECT_EQ((*found)[endless].ray().t_max, Ray{}.t_max);
}

TEST(RayList, TakesDirectionsOfAnyLength) {
  const auto found = read("0 0 0 0 1e300 0\n0 0 0 0 0 -1e-310\n");
  ASSERT_TRUE(found);
  EXPECT_EQ((*found)[0].unit(), 1e300);
  EXPECT_EQ((*found)[0].ray().direction.vec(), (Vec3d{0, 1, 0}));
  EXPECT_EQ((*found)[1].unit(), 1e-310);
  EXPECT_EQ((*found)[1].ray().direction.vec(), (Vec3d{0, 0, -1}));
}

TEST(RayList, TellsEveryBadLineWithItsPlace) {
  const auto found =
      read("1 2 3 0 0 1\n1 2 3 0 0 0\n1 2 3 0 0 1 2\n1 2 3 0 0 1 -1 2\n1 2 3 0 0 1 3 2\n1 2 x 0 0 1 inf inf\n");
  ASSERT_FALSE(found);
  ASSERT_EQ(found.why().size(), 5u);
  EXPECT_EQ(found.why()[0].where, (SourceLocation{"rays", 2, 7}));
  EXPECT_EQ(found.why()[1].where, (SourceLocation{"rays", 3, 1}));
  EXPECT_EQ(found.why()[2].where, (SourceLocation{"rays", 4, 13}));
  EXPECT_EQ(found.why()[3].where, (SourceLocation{"rays", 5, 15}));
  EXPECT_EQ(found.why()[4].where, (SourceLocation{"rays", 6, 5}));
}

}  // namespace
}  // namespace marrow
