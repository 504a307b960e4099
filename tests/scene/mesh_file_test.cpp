// The same tetrahedron or square in every notation.
#include "renderer/scene/files/mesh_file.h"

#include <bit>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

double area(const MeshShape& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += length(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])) / 2;
  return sum;
}

void expect_square(std::string_view bytes, const std::string& name) {
  const auto mesh = read_mesh(bytes, name);
  ASSERT_TRUE(mesh) << mesh.why()[0].message;
  EXPECT_EQ(mesh->triangles.size(), 2u);
  EXPECT_EQ(mesh->positions.size(), 4u);
  EXPECT_DOUBLE_EQ(area(*mesh), 1);
}

TEST(MeshFile, ReadsObj) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  expect_square(corners + "f 1 2 3 4\n", "a.obj");
  expect_square(corners + "f 1 2 3\nf 1 3 4\n", "a.OBJ");
  expect_square(corners + "f -4 -3 -2 -1\n", "a.obj");
  expect_square(corners + "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n", "a.obj");
  expect_square(corners + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n", "a.obj");
  const auto two = read_mesh(corners + "o first\nf 1 2 3\nl 1 2\no second\nf 1 3 4\n", "a.obj");
  ASSERT_TRUE(two);
  EXPECT_DOUBLE_EQ(area(*two), 1);
}

std::string ply(const std::string& format, const std::string& body) {
  return "ply\nformat " + format +
         " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         body;
}

std::string binary_square(bool swap) {
  std::string body;
  const auto put = [&](const void* data) {
    char bytes[4];
    std::memcpy(bytes, data, 4);
    if (swap != (std::endian::native == std::endian::big)) std::swap(bytes[0], bytes[3]), std::swap(bytes[1], bytes[2]);
    body.append(bytes, 4);
  };
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f}) put(&x);
  body += '\4';
  for (const std::int32_t i : {0, 1, 2, 3}) put(&i);
  return body;
}

TEST(MeshFile, ReadsPly) {
  expect_square(ply("ascii", "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"), "a.ply");
  expect_square(ply("binary_little_endian", binary_square(false)), "a.ply");
  expect_square(ply("binary_big_endian", binary_square(true)), "a.ply");
}

const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

// Cut anywhere but before its last line end, a file is refused, by a sentence.
TEST(MeshFile, RefusesFilesThatWereCut) {
  for (const std::string& whole :
       {ply("ascii", "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3"), ply("binary_little_endian", binary_square(false)),
        ply("binary_big_endian", binary_square(true))}) {
    ASSERT_TRUE(read_mesh(whole, "a.ply"));
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto mesh = read_mesh(whole.substr(0, size), "a.ply");
      ASSERT_FALSE(mesh) << size;
      EXPECT_FALSE(mesh.why().front().message.empty());
    }
  }
}

// Any bytes are changed: reading ends, and what it gives has no corner that is not there.
TEST(MeshFile, HoldsTogetherWhateverComes) {
  test::Random random(11);
  const std::vector<std::pair<std::string, std::string>> samples{
      {ply("ascii", "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3"), "a.ply"},
      {ply("binary_little_endian", binary_square(false)), "a.ply"},
      {tetrahedron, "a.obj"}};
  int read = 0;
  for (int i = 0; i < 20000; ++i) {
    auto [text, name] = samples[static_cast<std::size_t>(i) % samples.size()];
    const auto place = [&] { return static_cast<std::size_t>(random.whole(0, static_cast<int>(text.size()) - 1)); };
    for (int k = random.whole(1, 3); k > 0; --k) text[place()] = static_cast<char>(random.whole(0, 255));
    if (random.whole(0, 3) == 0) std::swap(text[place()], text[place()]);
    const auto mesh = read_mesh(text, name);
    if (!mesh) continue;
    ++read;
    for (const auto& triangle : mesh->triangles)
      for (const std::uint32_t corner : triangle) ASSERT_LT(corner, mesh->positions.size()) << text;
    for (const Vec3d& p : mesh->positions) ASSERT_TRUE(is_finite(p)) << text;
  }
  EXPECT_GT(read, 500);
}

std::string first_problem(const std::string& bytes, const std::string& name) {
  const auto mesh = read_mesh(bytes, name);
  if (mesh) return "none";
  const Diagnostic& first = mesh.why().front();
  return std::to_string(first.where.line) + ':' + std::to_string(first.where.column) + ' ' + first.message;
}

TEST(MeshFile, RefusesWhatIsNoMesh) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_FALSE(read_mesh("v 0 0 0\n", "a.stl"));
  EXPECT_EQ(first_problem("", "a.obj"), "0:0 the file is empty");
  EXPECT_EQ(first_problem("hello", "a.ply"), "0:0 not a PLY file: its first line is not `ply`");
  EXPECT_EQ(first_problem("v 0 0 0\nv 1 0 0\nl 1 2\n", "a.obj"), "0:0 the mesh has no face");
  EXPECT_EQ(first_problem(corners + "f 1 2 9\n", "a.obj"), "4:7 there is no vertex 9: the file has 3");
  EXPECT_EQ(first_problem(corners + "f 1 2 -4\n", "a.obj"), "4:7 there is no vertex -4: 3 came before");
  EXPECT_EQ(first_problem(corners + "f 1 2\n", "a.obj"), "4:1 a face needs three vertices");
  EXPECT_EQ(first_problem("v 0 0 0\nv 1 0 foo\n", "a.obj"), "2:7 `foo` is not a finite number");
  EXPECT_EQ(first_problem("v 0 0\n", "a.obj"), "1:6 the vertex ends after 2 numbers, it needs 3");
  EXPECT_EQ(first_problem("v 1 0 nan\n", "a.obj"), "1:7 `nan` is not a finite number");
  EXPECT_EQ(first_problem("v 1e16 0 0\n" + corners + "f 2 3 4\n", "a.obj"),
            "1:1 vertex 1 is not finite, or lies beyond 1e15");
}

TEST(MeshFile, RefusesWhatAPlyHeaderDoesNotAnnounce) {
  const std::string places = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_EQ(first_problem(ply("ascii", places + "4 0 1 2 9\n"), "a.ply"), "14:9 there is no vertex 9: the file has 4");
  EXPECT_EQ(first_problem(ply("ascii", places + "4 0 1 2 -1\n"), "a.ply"), "14:9 `-1` is no value of `face` 1 of 1");
  EXPECT_EQ(first_problem(ply("ascii", "0 0 0\n1 foo 0\n"), "a.ply"), "11:3 `foo` is no value of `vertex` 2 of 4");
  EXPECT_EQ(first_problem(ply("ascii", places), "a.ply"), "0:0 the file ends, or has a wrong value, in `face` 1 of 1");
  EXPECT_EQ(first_problem(ply("utf8", places), "a.ply"), "2:8 `utf8` is not a format");
  EXPECT_EQ(
      first_problem("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
                    "a.ply"),
      "0:0 the vertices have no property x, y or z");
  EXPECT_EQ(first_problem("ply\nformat ascii 1.0\nelement face 4000000000\nproperty list uchar int vertex_index\n"
                          "end_header\n3 0 1 2\n",
                          "a.ply"),
            "0:0 the file ends, or has a wrong value, in `face` 2 of 4000000000");
  EXPECT_EQ(first_problem("ply\nformat ascii 1.0\nelement vertex 4\nproperty real x\nend_header\n", "a.ply"),
            "4:10 `real` is not a type");
}

TEST(MeshFile, PassesOverWhatIsNoShape) {
  const auto mesh = read_mesh(
      "ply\r\nformat ascii 1.0\r\ncomment end_header\r\nelement edge 1\r\nproperty int a\r\nproperty list uchar float "
      "b\r\n"
      "element vertex 3\r\nproperty uchar red\r\nproperty double z\r\nproperty double y\r\nproperty double x\r\n"
      "element face 2\r\nproperty uchar kind\r\nproperty list uint8 int32 vertex_index\r\nelement none "
      "9000000000000\r\n"
      "end_header\r\n7 2 nan 0.5\r\n-nan 3 2 0.1\r\n0 0 0 1\r\n0 0 1 0\r\n0 3 0 1 2\r\n0 2 0 1\r\n",
      "a.ply");
  ASSERT_TRUE(mesh) << mesh.why()[0].message;
  ASSERT_EQ(mesh->triangles.size(), 1u);
  EXPECT_EQ(mesh->positions[0].x, 0.1);
  EXPECT_EQ(mesh->positions[0].z, 3);
}

// A letter C, seen from either side and along each axis.
TEST(MeshFile, SplitsConcaveFaces) {
  const double outline[][2] = {{0, 0}, {2, 0}, {2, 1}, {0.5, 1}, {0.5, 2}, {2, 2}, {2, 3}, {0, 3}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool is_turned : {false, true})
      for (int first = 0; first < 8; ++first) {
        std::string text;
        for (const auto& [u, v] : outline) {
          std::string number[3] = {"1e5", "1e5", "1e5"};
          number[(axis + 1) % 3] = std::to_string(u);
          number[(axis + 2) % 3] = std::to_string(v);
          text += "v " + number[0] + ' ' + number[1] + ' ' + number[2] + '\n';
        }
        text += 'f';
        for (int i = 0; i < 8; ++i) text += ' ' + std::to_string((first + (is_turned ? 8 - i : i)) % 8 + 1);
        const auto mesh = read_mesh(text, "c.obj");
        ASSERT_TRUE(mesh);
        EXPECT_EQ(mesh->triangles.size(), 6u);
        EXPECT_NEAR(area(*mesh), 4.5, 1e-9) << text;
        const auto& t = mesh->triangles[0];
        const Vec3d normal =
            cross(mesh->positions[t[1]] - mesh->positions[t[0]], mesh->positions[t[2]] - mesh->positions[t[0]]);
        EXPECT_EQ(normal[static_cast<std::size_t>(axis)] < 0, is_turned);
      }
}

TEST(MeshFile, SplitsStarsAndSpirals) {
  test::Random random(12);
  for (int i = 0; i < 200; ++i) {
    const int corners = random.whole(4, 60);
    std::string text, face = "f";
    double expected = 0, last = 0, first = 0;
    const double step = 2 * std::numbers::pi / corners;
    for (int k = 0; k < corners; ++k) {
      const double radius = random.between(0.2, 1);
      text += fmt::format("v {:.17g} {:.17g} 0\n", radius * cos(k * step), radius * sin(k * step));
      face += ' ' + std::to_string(k + 1);
      if (k == 0) first = radius;
      else expected += last * radius * sin(step) / 2;
      last = radius;
    }
    expected += last * first * sin(step) / 2;
    const auto mesh = read_mesh(text + face, "star.obj");
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->triangles.size(), static_cast<std::size_t>(corners) - 2);
    EXPECT_NEAR(area(*mesh), expected, 1e-9) << text;
  }
}

TEST(MeshFile, RefusesConcaveFacesOfVeryManyCorners) {
  std::string text, face = "f";
  for (int i = 0; i < 5000; ++i) {
    text += fmt::format("v {} {} 0\n", i, i % 2);
    face += ' ' + std::to_string(i + 1);
  }
  EXPECT_EQ(first_problem(text + "v 2500 9000 0\n" + face + " 5001\n", "a.obj"),
            "5002:1 a face of 5001 corners that is not convex");
}

}  // namespace
}  // namespace marrow
