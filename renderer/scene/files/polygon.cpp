// In the plane of two coordinates, that in which the polygon is largest.
#include "renderer/scene/files/polygon.h"

#include <cmath>

namespace marrow {
namespace {

struct Flat {
  double u, v;
};

// Twice the area of a triangle; above 0 when it turns to the left.
double turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

// Corners about the first one, so that a mesh far from the origin keeps its digits; turning to the left.
std::vector<Flat> flattened(std::span<const std::uint32_t> corners, std::span<const Vec3d> positions) {
  const Vec3d origin = positions[corners[0]];
  Vec3d normal{};
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal = normal + cross(positions[corners[i]] - origin, positions[corners[(i + 1) % corners.size()]] - origin);
  std::size_t axis = 0;
  for (const std::size_t i : {1, 2})
    if (std::fabs(normal[i]) > std::fabs(normal[axis])) axis = i;
  std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  std::vector<Flat> flat;
  for (const std::uint32_t corner : corners) {
    const Vec3d from_origin = positions[corner] - origin;
    flat.push_back({from_origin[u], from_origin[v]});
  }
  return flat;
}

class EarCutter {
 public:
  explicit EarCutter(const std::vector<Flat>& flat) : flat_(flat) {
    for (std::size_t i = 0; i < flat.size(); ++i) ring_.push_back(i);
  }

  bool is_convex() const {
    for (std::size_t i = 0; i < ring_.size(); ++i)
      if (turn_at(i) < 0) return false;
    return true;
  }

  // Calls add(a, b, c) for each triangle. Where a polygon that crosses itself has no ear, its next corner counts as
  // one.
  template <class Add>
  void cut(const Add& add) {
    for (std::size_t i = 0, without = 0; ring_.size() > 3;) {
      if (i >= ring_.size()) i = 0;
      if (!is_ear(i) && ++without <= ring_.size()) {
        ++i;
        continue;
      }
      add(ring_[before(i)], ring_[i], ring_[after(i)]);
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(i));
      without = 0;
    }
    add(ring_[0], ring_[1], ring_[2]);
  }

 private:
  std::size_t before(std::size_t i) const { return (i == 0 ? ring_.size() : i) - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == ring_.size() ? 0 : i + 1; }
  const Flat& at(std::size_t i) const { return flat_[ring_[i]]; }
  double turn_at(std::size_t i) const { return turn(at(before(i)), at(i), at(after(i))); }

  // It turns to the left, and no other corner of the polygon lies in its triangle. Corners on the border count, but
  // those at the same places as its own, where a hole is joined to the outline.
  bool is_ear(std::size_t i) const {
    const Flat &a = at(before(i)), &b = at(i), &c = at(after(i));
    if (!(turn(a, b, c) > 0)) return false;
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      if (k == i || k == before(i) || k == after(i)) continue;
      const Flat& p = at(k);
      const auto is_at = [&](const Flat& q) { return p.u == q.u && p.v == q.v; };
      if (is_at(a) || is_at(b) || is_at(c)) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  const std::vector<Flat>& flat_;
  std::vector<std::size_t> ring_;  // corners that are left
};

}  // namespace

bool append_triangles(std::span<const std::uint32_t> corners, std::span<const Vec3d> positions,
                      std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({corners[a], corners[b], corners[c]});
  };
  if (corners.size() == 3) return add(0, 1, 2), true;
  const std::vector<Flat> flat = flattened(corners, positions);
  EarCutter cutter(flat);
  if (cutter.is_convex()) {
    for (std::size_t i = 2; i < corners.size(); ++i) add(0, i - 1, i);
    return true;
  }
  if (corners.size() > most_concave_corners) return false;
  cutter.cut(add);
  return true;
}

}  // namespace marrow
