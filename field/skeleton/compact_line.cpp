// Nodes between the ends of a support that move with the point.
#include "field/skeleton/compact_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "field/kernel/inverse_family.h"
#include "field/kernel/panels.h"
#include "field/kernel/profile.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

using X = HessianJet;

struct MovingLine {
  Vec3d u;
  X t1, t2, at_foot, h_squared;  // as in Line
  Vec3<X> across;
  double slope;
};

MovingLine seen_by(const SegmentSkeleton& s, const Vec3<X>& p, double length) {
  MovingLine line;
  line.u = (s.to - s.from) / length;
  line.slope = (s.radius_to - s.radius_from) / length;
  const X foot = dot(p - s.from, line.u);
  line.across = p - s.from - constant<X>(line.u) * foot;
  line.t1 = -foot;
  line.t2 = length - foot;
  line.at_foot = s.radius_from + line.slope * foot;
  line.h_squared = square(line.across.x) + square(line.across.y) + square(line.across.z);
  return line;
}

X asin_of(const X& x) {
  const double rest = (1 - x.value) * (1 + x.value), slope = 1 / std::sqrt(rest);
  return X::chain(x, asin(x.value), slope, x.value * slope / rest);
}

// Calls visit(t, dt) at the nodes of panels over [a, b], t and dt/dx given by the place x.
template <class At>
void over_panels(const X& a, const X& b, std::span<const Singularity> poles, double longest, const At& at) {
  const double width = b.value - a.value;
  if (!(width > 0)) return;
  for_each_panel(a.value, b.value, poles, longest, [&](const Panel& panel) {
    for_each_node(panel, max_kernel_degree, [&](double x, double weight) {
      at(a + (b - a) * ((x - a.value) / width), (b - a) * (weight / width));
    });
  });
}

// As in line_integral.h: where A t^2 + 2 B t + C < 0.
template <class Visit>
void between_roots(const MovingLine& line, const X& middle, const X& half, const Visit& visit) {
  const auto angle_of = [&](const X& t) {
    const X s = (t - middle) / half;
    if (!(std::fabs(s.value) < 1)) return X(std::copysign(std::numbers::pi / 2, s.value));
    return asin_of(s);
  };
  std::array<Singularity, 1> pole{Singularity{0, std::numeric_limits<double>::infinity()}};
  if (line.slope != 0) {
    const double at = (-line.at_foot.value / line.slope - middle.value) / half.value;
    pole[0] = {std::copysign(std::numbers::pi / 2, at), acosh(std::max(1.0, std::fabs(at)))};
  }
  over_panels(angle_of(line.t1), angle_of(line.t2), pole, 1,
              [&](const X& angle, const X& weight) { visit(middle + half * sin(angle), weight * half * cos(angle)); });
}

template <class Visit>
void beyond_root(const MovingLine& line, const X& root, const Visit& visit) {
  const double direction = line.slope > 0 ? 1 : -1;
  const X& near = direction > 0 ? line.t1 : line.t2;
  const X& far = direction > 0 ? line.t2 : line.t1;
  const auto w_of = [&](const X& t) { return sqrt(max(direction * (t - root), X(0.0))); };
  const Singularity pole{0, std::sqrt(std::fabs(root.value + line.at_foot.value / line.slope))};
  const X begin = w_of(near), end = w_of(far);
  over_panels(begin, end, {&pole, 1}, end.value,
              [&](const X& w, const X& weight) { visit(root + direction * square(w), 2.0 * weight * w); });
}

template <class Visit>
void integrate(const MovingLine& line, double R, const Visit& visit) {
  const double A = 1 - R * R * line.slope * line.slope;
  const X B = -R * R * line.slope * line.at_foot, C = line.h_squared - R * R * square(line.at_foot);
  const X discriminant = square(B) - A * C;
  if (A > 0) {
    if (discriminant.value > 0) between_roots(line, -B * (1 / A), sqrt(discriminant) * (1 / A), visit);
    return;
  }
  const X root_of = sqrt(max(discriminant, X(0.0))), q = B.value < 0 ? -B + root_of : -B - root_of;
  const X first = q.value == 0 ? X(0.0) : C / q, second = A == 0 ? first : q * (1 / A);
  const bool takes_first =
      line.at_foot.value + line.slope * first.value >= line.at_foot.value + line.slope * second.value;
  beyond_root(line, takes_first ? first : second, visit);
}

// x^(m/2) of x > 0
X half_power(const X& x, int m) {
  const X whole = integer_power(x, m / 2);
  return m % 2 == 0 ? whole : whole * sqrt(x);
}

}  // namespace

SecondOrderSample compact_line(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel, bool share) {
  SecondOrderSample sum;
  const double length = marrow::length(s.to - s.from), R = kernel.shape;
  const MovingLine line = seen_by(s, variables_at<HessianJet>(p), length);
  const Profile profile(kernel, 1);
  const int m = profile.degree();
  integrate(line, R, [&](const X& t, const X& weight) {
    const X tau = line.at_foot + line.slope * t, inside = 1.0 - (square(t) + line.h_squared) / (R * R * square(tau));
    if (!(inside.value > 0)) return;
    X part = weight / (profile.normalisation() * tau);
    if (share) part = part * (t - line.t1) * (1 / length);
    const X lower = half_power(inside, m - 2) * part;
    sum.field += lower * inside;
    const X fall = lower / tau * (-m / (R * R));
    for (std::size_t c = 0; c < 3; ++c) sum.si[c] += fall * (line.across[c] - line.u[c] * t);
  });
  return sum;
}

}  // namespace marrow
