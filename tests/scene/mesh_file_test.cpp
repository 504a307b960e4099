// The same tetrahedron or square in every notation.
#include "renderer/scene/files/mesh_file.h"

#include <bit>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

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

// Cut anywhere, a file is refused or read in part, but reading always ends.
TEST(MeshFile, EndsOnFilesThatWereCut) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  for (std::size_t size = 0; size < ply.size(); ++size) {
    const auto mesh = read_mesh(ply.substr(0, size), "a.ply");
    EXPECT_EQ(static_cast<bool>(mesh) && size < ply.find("0 0 0"), false) << size;
  }
}

TEST(MeshFile, RefusesWhatIsNoMesh) {
  EXPECT_FALSE(read_mesh("v 0 0 0\n", "a.stl"));
  EXPECT_EQ(read_mesh("", "a.obj").why().front().message, "the file is empty");
  EXPECT_FALSE(read_mesh("hello", "a.ply"));
  EXPECT_FALSE(read_mesh("v 0 0 0\nv 1 0 0\nl 1 2\n", "a.obj"));
  EXPECT_FALSE(read_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "a.obj"));
  EXPECT_FALSE(read_mesh("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj"));
}

}  // namespace
}  // namespace marrow
