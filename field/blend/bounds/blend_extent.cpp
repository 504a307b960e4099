// How far the surface of a blend can reach.
#include <algorithm>
#include <cmath>
#include <vector>

#include "field/blend/bounds/blend_bounds.h"
#include "field/kernel/inverse_family.h"
#include "field/kernel/profile.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

// Upper bounds of f and G of all primitives together from a distance on: sums of mass / d^m.
struct Tail {
  double mass, radius;
  int m;
};

std::vector<Tail> tails(const BlendField& blend) {
  const int n = blend.degree;
  const Kernel kernel = kernel_of(blend);
  const auto scale = [&](int dimension) {
    if (blend.kernel == KernelFamily::Inverse)
      return dimension == 0 ? 1.0 : dimension == 1 ? 1 / curve_normalisation(n) : 1 / surface_normalisation(n);
    // (1 + s^2 x^2)^(-m/2) <= (s x)^-m; the compact kernel is below every power that is 1 at its support
    const Profile profile(kernel, dimension);
    const double s = blend.kernel == KernelFamily::Cauchy ? 1 / blend.kernel_shape : blend.kernel_shape;
    return integer_power(s, kernel_degree(n, dimension)) / profile.normalisation();
  };
  std::vector<Tail> all;
  const auto add = [&](double radius, double measure, int dimension) {
    all.push_back({scale(dimension) * measure * integer_power(radius, n - 1), radius, kernel_degree(n, dimension)});
  };
  for (const auto& s : blend.points.skeletons) add(s.radius, 1, 0);
  for (const auto* list : {&blend.segments, &blend.cani_hornus_segments})
    for (const auto& s : list->skeletons) add(largest_radius(s), length(s.to - s.from), 1);
  for (const auto& s : blend.arcs.skeletons) add(largest_radius(s), s.major * (s.end - s.begin), 1);
  for (const auto& s : blend.triangles.skeletons)
    add(largest_radius(s), 0.5 * length(cross(s.vertices[1] - s.vertices[0], s.vertices[2] - s.vertices[0])), 2);
  for (const auto& s : blend.distance_segments.skeletons) add(largest_radius(s), 1, 0);
  for (const auto& s : blend.distance_triangles.skeletons) add(largest_radius(s), 1, 0);
  for (const auto& s : blend.distance_arcs.skeletons) add(largest_radius(s), 1, 0);
  return all;
}

}  // namespace

Box3 blend_extent(const BlendField& blend, double level) {
  const Box3 skeletons = skeleton_bounds(blend);
  if (skeletons.empty()) return skeletons;
  if (blend.kernel == KernelFamily::Compact)
    return skeletons.padded(blend.kernel_shape * largest_radius(blend) * (1 + 1e-12));
  if (!(level > 0)) return {{-Box3::inf, -Box3::inf, -Box3::inf}, {Box3::inf, Box3::inf, Box3::inf}};
  const std::vector<Tail> all = tails(blend);
  // Whatever alpha is: from 0 on C lies between f and the curve at G, below 0 it is twice that at most.
  const Correction along_f = correction_at(blend, 0);
  const auto highest = [&](double d) {
    double f = 0, G = 0;
    for (const Tail& t : all) {
      const double x = t.mass / integer_power(d, t.m);
      f += x;
      G += t.m * x * t.radius / d;
    }
    if (blend.kernel != KernelFamily::Inverse) return std::max(f, along_f.value(f, G));
    return std::max(f, 2 * ReferenceCurve(blend.degree).inverse(G));
  };
  double margin = largest_radius(blend);
  while (!(highest(margin) < level * (1 - 1e-9)) && margin < 1e30) margin *= 1.25;
  return skeletons.padded(margin);
}

}  // namespace marrow
