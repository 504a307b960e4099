#include "field/trace/curve/largest_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/blend/blend_field.h"
#include "field/kernel/inverse_family.h"
#include "field/math/elementary.h"
#include "field/skeleton/radii.h"

namespace marrow {
namespace {

// What a segment has of the sum of tau^(n-1), over the power of its largest radius: a linear radius leaves a n-th part
// at least, and an even one all of it.
double length_that_counts(const SegmentSkeleton& s, int n) {
  const double thin = least_radius(s) / largest_radius(s);
  return length(s.to - s.from) / largest_radius(s) * std::max(1.0 / n, integer_power(thin, n - 1));
}

}  // namespace

// Beyond the G of the reference curve at the iso-value, n - 1, f is below 1 where C is 1, as C is isotone. A piece of
// the length l radii no farther than d radii has f >= l / (c (d + l)^n), so that d >= (l / c)^(1/n) - l for each l up
// to that of the segment: most for l^((n-1)/n) = 1 / (n c^(1/n)). |grad_S f| is at most n / d times f, and that of a
// sum no more than that of what is nearest.
double largest_gradient(const BlendField& blend) {
  const int n = blend.degree;
  double shortest = 1;
  for (const SegmentSkeleton& s : blend.segments.skeletons) shortest = std::min(shortest, length_that_counts(s, n));
  const double c = curve_normalisation(n), best = pow(1 / (n * pow(c, 1.0 / n)), n / (n - 1.0));
  const double l = std::min(shortest, best), d = pow(l / c, 1.0 / n) - l;
  return d > 0 ? n / d : std::numeric_limits<double>::infinity();
}

}  // namespace marrow
