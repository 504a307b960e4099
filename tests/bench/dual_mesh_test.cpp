// The meshed rival is the same shape: closed, oriented, and as large.
#include "renderer/bench/dual_mesh.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

namespace marrow {
namespace {

// A ball without any tracer.
class Ball final : public Surfaces {
 public:
  using Surfaces::first_hit;
  std::optional<SurfaceHit> first_hit(const Ray& ray, RayRecord&) const override {
    const double middle = -dot(ray.origin, ray.direction.vec());
    const double half2 = 1 - length_squared(ray.origin) + middle * middle;
    if (half2 < 0 || middle - std::sqrt(half2) < 0) return {};
    SurfaceHit hit;
    hit.t = middle - std::sqrt(half2);
    hit.position = hit.outside = ray.at(hit.t);
    hit.normal = normalize(hit.position);
    return hit;
  }
  bool occluded(const Ray& ray) const override { return Surfaces::first_hit(ray).has_value(); }
  Box3 bounds() const override { return {{-1, -1, -1}, {1, 1, 1}}; }
};

Vec3d vertex(const TriangleMesh& mesh, std::uint32_t i) {
  const auto& v = mesh.vertices[i];
  return {double(v[0]), double(v[1]), double(v[2])};
}

TEST(DualMesh, OfABallIsABall) {
  const double spacing = 0.0473;  // so that no grid point lies on the surface
  const auto made = dual_mesh(Ball(), spacing);
  ASSERT_TRUE(made);
  const TriangleMesh& mesh = *made;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    volume += dot(vertex(mesh, t[0]), cross(vertex(mesh, t[1]), vertex(mesh, t[2]))) / 6;
  }
  // Each edge once in each direction: closed, and every triangle seen from outside the same way round
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_NEAR(volume, 4 * std::numbers::pi / 3, 0.02);
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) EXPECT_NEAR(length(vertex(mesh, i)), 1, spacing * spacing);
  EXPECT_GT(mesh.triangles.size(), 6000u);
}

TEST(DualMesh, OfAGridThatFitsInNoMemoryIsRefused) {
  for (const double spacing : {1e-9, 1e-300, 0.0, -1.0, std::nan("")})
    EXPECT_FALSE(dual_mesh(Ball(), spacing)) << spacing;
  EXPECT_TRUE(dual_mesh(Ball(), 1e15));
}

TEST(DualMesh, IsAsFineAsItsCornersAllow) {
  const Box3 ball = Ball().bounds(), stick{{0, 0, 0}, {1e6, 1e-3, 1e-3}};
  EXPECT_NEAR(finest_mesh_spacing(ball), 2 * 1.25 / 807, 2e-4);  // 807^3 is nearly 2^29
  for (const Box3& box : {ball, stick, Box3{{0, 0, 0}, {0, 0, 0}}}) EXPECT_GT(finest_mesh_spacing(box), 0);
  EXPECT_LT(finest_mesh_spacing(stick), 1);  // where a cube of its length would have 10^18
  EXPECT_NEAR(finest_mesh_spacing({{0, 0, 0}, {2e6, 2e6, 2e6}}) / finest_mesh_spacing(ball), 1e6, 1e-3);
}

}  // namespace
}  // namespace marrow
