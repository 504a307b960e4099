// Surface nets from the roots of rays along grid lines.
#include "renderer/bench/dual_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace marrow {
namespace {

using Index = std::array<int, 3>;

// Surfaces may swell beyond the bounds: an eighth of the size, and two cubes.
double margin_of(double size, double spacing) { return size / 8 + 2 * spacing; }

// In double, as it may be any number.
double corners_along(double size, double spacing) {
  return std::ceil((size + 2 * margin_of(size, spacing)) / spacing) + 1;
}
double corners(const Vec3d& size, double spacing) {
  return corners_along(size.x, spacing) * corners_along(size.y, spacing) * corners_along(size.z, spacing);
}

// Where an edge from the corner `corner` along `axis` meets the surface.
struct Crossing {
  std::uint32_t corner;
  std::uint8_t axis;
  bool upward;  // from outside at the corner to inside at the edge's other end
  std::array<float, 3> at;
};

// Space outside is flooded along grid edges: every ray starts at a corner that is known to be outside, so the first
// surface it meets is one seen from outside.
class Flood {
 public:
  Flood(const Surfaces& surfaces, double spacing, StopRequest stop)
      : surfaces_(surfaces), spacing_(spacing), stop_(stop) {
    const Box3 box = surfaces.bounds();
    for (std::size_t i = 0; i < 3; ++i) {
      lower_[i] = box.lower[i] - margin_of(box.size()[i], spacing);
      count_[i] = static_cast<int>(corners_along(box.size()[i], spacing));
    }
    known_.assign(std::size_t(count_[0]) * std::size_t(count_[1]) * std::size_t(count_[2]), 0);
  }

  std::vector<Crossing> crossings;

  void run() {
    reach({0, 0, 0});
    while (!front_.empty() && !stop_.is_made()) {
      const Index corner = front_.back();
      front_.pop_back();
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool up : {true, false}) shoot(corner, axis, up);
    }
  }

  std::uint32_t number(const Index& i) const {
    return static_cast<std::uint32_t>((i[2] * count_[1] + i[1]) * count_[0] + i[0]);
  }
  std::uint32_t stride(std::size_t axis) const {
    return static_cast<std::uint32_t>(axis == 0 ? 1 : axis == 1 ? count_[0] : count_[0] * count_[1]);
  }
  std::size_t corner_count() const { return known_.size(); }

 private:
  static constexpr std::uint8_t outside = 8;  // bits 0 to 2: the edge upward along an axis is known

  void reach(const Index& corner) {
    std::uint8_t& known = known_[number(corner)];
    if (known & outside) return;
    known |= outside;
    front_.push_back(corner);
  }
  // The lower end of the edge that leaves `corner`.
  static Index edge_of(Index corner, std::size_t axis, bool up) {
    if (!up) --corner[axis];
    return corner;
  }
  bool has_unknown_edge(const Index& corner, std::size_t axis, bool up) const {
    if (up ? corner[axis] + 1 == count_[axis] : corner[axis] == 0) return false;
    return !(known_[number(edge_of(corner, axis, up))] >> axis & 1);
  }
  // As far as edges are unknown and outside.
  void shoot(Index corner, std::size_t axis, bool up) {
    if (!has_unknown_edge(corner, axis, up)) return;
    const int step = up ? 1 : -1;
    Vec3d origin = lower_, direction{};
    for (std::size_t i = 0; i < 3; ++i) origin[i] += corner[i] * spacing_;
    direction[axis] = step;
    const Ray ray{origin, UnitVec3::unchecked(direction)};
    const auto hit = surfaces_.first_hit(ray);
    const double free = hit ? hit->t / spacing_ : 1e9;
    for (int passed = 0; has_unknown_edge(corner, axis, up); ++passed) {
      const Index edge = edge_of(corner, axis, up);
      known_[number(edge)] |= static_cast<std::uint8_t>(1U << axis);
      if (passed + 1 > free) {
        const Vec3d& p = hit->position;
        crossings.push_back({number(edge),
                             static_cast<std::uint8_t>(axis),
                             up,
                             {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}});
        return;
      }
      corner[axis] += step;
      reach(corner);
    }
  }

  const Surfaces& surfaces_;
  double spacing_;
  StopRequest stop_;
  Vec3d lower_;
  Index count_{};
  std::vector<std::uint8_t> known_;
  std::vector<Index> front_;
};

constexpr std::uint32_t none = 0xffffffffU;

// The four cubes around an edge, in turn; a cube has the number of its lowest corner.
std::array<std::uint32_t, 4> cubes_around(const Crossing& c, const Flood& grid) {
  const std::uint32_t u = grid.stride((c.axis + 1U) % 3), v = grid.stride((c.axis + 2U) % 3);
  return {c.corner - u - v, c.corner - v, c.corner, c.corner - u};
}

}  // namespace

double finest_mesh_spacing(const Box3& bounds) {
  constexpr double most_corners = double{1 << 29};
  const Vec3d size = bounds.size();
  double coarse = std::max(max_component(size), 1e-300), fine = coarse * 1e-9;
  while (coarse > 1.001 * fine) {
    const double middle = std::sqrt(coarse) * std::sqrt(fine);
    (corners(size, middle) <= most_corners ? coarse : fine) = middle;
  }
  constexpr double as_printed = 1 - 1e-12;  // two digits, read back, must not be below it
  const double digit = std::pow(10, std::floor(std::log10(coarse)) - 1);
  return std::ceil(coarse / digit) * digit * as_printed;
}

Result<TriangleMesh> dual_mesh(const Surfaces& surfaces, double spacing, StopRequest stop) {
  if (const double finest = finest_mesh_spacing(surfaces.bounds()); !(spacing >= finest))
    return failure(fmt::format("a grid of {:.6g} scene units is too fine; from {:.6g} on it fits", spacing, finest));
  Flood grid(surfaces, spacing, stop);
  grid.run();
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of(grid.corner_count(), none), weight;
  for (const Crossing& c : grid.crossings) {
    std::array<std::uint32_t, 4> v{};
    const auto cubes = cubes_around(c, grid);
    for (std::size_t i = 0; i < 4; ++i) {
      std::uint32_t& vertex = vertex_of[cubes[i]];
      if (vertex == none) {
        vertex = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back({0, 0, 0});
        weight.push_back(0);
      }
      v[i] = vertex;
      for (std::size_t k = 0; k < 3; ++k) mesh.vertices[vertex][k] += c.at[k];
      ++weight[vertex];
    }
    if (c.upward) std::swap(v[1], v[3]);  // seen from outside, counter-clockwise
    mesh.triangles.push_back({v[0], v[1], v[2]});
    mesh.triangles.push_back({v[0], v[2], v[3]});
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (float& x : mesh.vertices[i]) x /= static_cast<float>(weight[i]);
  return mesh;
}

}  // namespace marrow
