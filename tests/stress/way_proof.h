// Proves, from few values of the exact field, that a stretch of a ray is all outside, or all inside.
#pragma once

#include <vector>

#include "field/blend/blend_field.h"
#include "field/math/ray.h"
#include "tests/stress/level_table.h"

namespace marrow::test {

/// What the exact field is at a place of a ray, all in double.
struct Place {
  double t;
  double f, slope;  // along the ray
  Vec3d g, bend;    // grad_S f and its derivative along the ray
  double n_k;       // at least n K, K = sum of what each source has of f, times its radius / distance^3
  double distance;  // to the nearest skeleton, from below
};

/// Between two places a and b, h apart, f and grad_S f are cubics, by values and slopes at both (Hermite), but for a
/// remainder of a fourth derivative, which is bounded source by source. Along a line one at the distance D has
///   |d^k/dt^k D^-m| <= m (m+1) ... (m+k-1) D^-(m+k)
/// (Gegenbauer polynomials are largest at 1), and its gradient the same with one k more. Between the places
///   D^2 = (1-u) D_a^2 + u D_b^2 - u (1-u) h^2      (Stewart)
/// is at least (1-u) D_a^2 + u D_b^2 times 1 - (h / (d_a + d_b))^2, where d_a, d_b are the distances to the nearest
/// skeleton. D^-m is convex in D^2: a sum of it is at most the larger one of both ends, times the power -m/2 of that
/// factor.
///
/// In Bernstein's form coefficients bound a cubic: where those of f and the lengths of those of grad_S f, with what
/// they are off, leave the operator on its side of the level, it is there all along. Else the stretch is halved, and
/// where that does not help another place is put between.
///
/// What is proved here needs no further look; what is not proved may be so all the same. Nothing is proved where the
/// angle varies. Like the oracle this relies on the operator being monotone, and on nothing of the tracer.
class WayProof {
 public:
  /// Ways count as outside where the corrected field is below `level`, as inside where it is above `other` < `level`.
  /// Both are about 1: for alpha < 0 the operator is not as it has to be where it is tiny.
  WayProof(const BlendField&, double level, double other);

  Place place(const Ray&, double t) const;
  /// From `begin` to `end`, except within 1e-6 of the distance to the skeleton after `begin`, but at `begin` too.
  /// `beyond`: a place at or after `end`, or null.
  bool is_outside(const Ray&, double begin, double end, const Place* beyond) const;
  /// From `begin` to `end`. Only proved for alpha >= 0.
  bool is_inside(const Ray&, double begin, double end) const;

 private:
  enum class Side { Outside, Inside };
  struct Stretch;
  struct Cubic;
  struct Effort;
  bool holds(Side, const Ray&, const Place& a, const Place& b, Stretch, Effort&) const;
  bool holds_between(Side, const Ray&, const Place& a, const Place& b, Stretch, Effort&) const;
  bool holds_on(Side, const Cubic&, Effort&) const;
  bool holds_at(Side, double least_f, double largest_f, double least_G, double largest_G) const;

  const BlendField& blend_;
  LevelTable table_;
  double other_;
};

}  // namespace marrow::test
