// An oracle for fields: the definitions themselves, integrated in any precision, sharing nothing with the library but
// the plain data of skeletons. No closed form, no recurrence, no stable rearrangement.   [Zanni et al. 2015, sec. 3, 4]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "field/description/field_node.h"

namespace marrow::test::oracle {

template <class Real>
using V = Vec3<Real>;

template <class Real>
V<Real> vector_of(const Vec3d& v) {
  return {Real(v.x), Real(v.y), Real(v.z)};
}
template <class Real>
Real size_of(const V<Real>& v) {
  using std::sqrt;
  return sqrt(Real(dot(v, v)));
}
template <class Real>
Real pi() {
  using std::atan;
  return 4 * atan(Real(1));
}

/// Gauss-Legendre on [0, 1], nodes by Newton's method from the usual guess.
template <class Real>
struct Rule {
  std::vector<Real> nodes, weights;
  explicit Rule(int count) {
    for (int i = 0; i < count; ++i) {
      Real x = Real(std::cos(3.141592653589793 * (i + 0.75) / (count + 0.5))), slope;
      for (int step = 0; step < 12; ++step) {
        Real p0 = 1, p1 = x;
        for (int k = 2; k <= count; ++k) {
          const Real p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
          p0 = p1;
          p1 = p2;
        }
        slope = count * (x * p1 - p0) / (x * x - 1);
        x -= p1 / slope;
      }
      nodes.push_back((1 + x) / 2);
      weights.push_back(1 / ((1 - x * x) * slope * slope));
    }
  }
};
template <class Real>
const Rule<Real>& rule() {
  static const Rule<Real> r(40);
  return r;
}
/// Error 4^-80 where the integrand is regular within a panel's length around it.
template <class Real, class Visit>
void over(const Real& a, const Real& b, const Visit& visit) {
  const Rule<Real>& r = rule<Real>();
  for (std::size_t i = 0; i < r.nodes.size(); ++i) visit(Real(a + (b - a) * r.nodes[i]), Real((b - a) * r.weights[i]));
}
/// With u^2 (3 - 2u) in place of u, so that square roots at either end are regular.
template <class Real, class Visit>
void over_with_roots(const Real& a, const Real& b, int panels, const Visit& visit) {
  for (int i = 0; i < panels; ++i)
    over<Real>(Real(i) / panels, Real(i + 1) / panels, [&](const Real& u, const Real& weight) {
      visit(Real(a + (b - a) * u * u * (3 - 2 * u)), Real((b - a) * 6 * u * (1 - u) * weight));
    });
}

inline int degree_of(const Kernel& k, int dimension) {
  return k.family == KernelFamily::Compact ? k.degree + 1 - dimension : k.degree - 1 + dimension;
}
/// k_m(x) and k_m'(x) / x.
template <class Real>
struct KernelValue {
  Real value, slope;
};
template <class Real>
KernelValue<Real> kernel_at(const Kernel& kernel, int m, const Real& x_squared) {
  using std::pow;
  const Real half = Real(m) / 2, shape2 = Real(kernel.shape) * kernel.shape;
  if (kernel.family == KernelFamily::Inverse)
    return {pow(x_squared, Real(-half)), Real(-m * pow(x_squared, Real(-half - 1)))};
  if (kernel.family == KernelFamily::Cauchy) {
    const Real u = 1 + shape2 * x_squared;
    return {pow(u, Real(-half)), Real(-m * shape2 * pow(u, Real(-half - 1)))};
  }
  const Real u = 1 - x_squared / shape2;
  if (u <= 0) return {Real(0), Real(0)};
  return {pow(u, half), Real(-m / shape2 * pow(u, Real(half - 1)))};
}

/// N: the integral over an infinite line or plane at distance 1, over the angle from the foot.
template <class Real>
Real normalisation(const Kernel& kernel, int dimension) {
  using std::acos;
  using std::cos;
  using std::sin;
  const int m = degree_of(kernel, dimension);
  if (dimension == 0) return kernel_at(kernel, m, Real(1)).value;
  const Real last = kernel.family == KernelFamily::Compact ? Real(acos(Real(1) / kernel.shape)) : pi<Real>() / 2;
  Real sum = 0;
  over_with_roots<Real>(Real(0), last, 16, [&](const Real& angle, const Real& weight) {
    const Real c = cos(angle), area = dimension == 1 ? Real(2) : Real(2 * pi<Real>() * sin(angle) / c);
    sum += weight * area / (c * c) * kernel_at(kernel, m, Real(1 / (c * c))).value;
  });
  return sum;
}

template <class Real>
struct Sums {
  Real value = 0;
  V<Real> gradient{Real(0), Real(0), Real(0)}, si{Real(0), Real(0), Real(0)};

  void add(const Kernel& kernel, int dimension, const V<Real>& v, const Real& tau, const Real& weight) {
    const auto [k, slope] = kernel_at(kernel, degree_of(kernel, dimension), Real(dot(v, v) / (tau * tau)));
    Real share = weight;
    for (int i = 0; i < dimension; ++i) share /= tau;
    value += share * k;
    si += v * Real(share * slope / tau);
    gradient += v * Real(share * slope / (tau * tau));
  }
  void scale(const Real& s) {
    value *= s;
    si = si * s;
    gradient = gradient * s;
  }
};

/// Halves [a, b] until `is_short(a, b)`, and integrates each piece.
template <class Real, class IsShort, class Visit>
void over_pieces(const Real& a, const Real& b, const IsShort& is_short, const Visit& visit, int depth = 0) {
  if (depth < 60 && !is_short(a, b)) {
    const Real middle = (a + b) / 2;
    over_pieces(a, middle, is_short, visit, depth + 1);
    over_pieces(middle, b, is_short, visit, depth + 1);
  } else {
    over<Real>(a, b, visit);
  }
}

/// Where a function of [a, b] changes its sign, by a scan and halving.
template <class Real, class Function>
std::vector<Real> sign_changes(const Real& a, const Real& b, const Function& f) {
  constexpr int parts = 400;
  std::vector<Real> found;
  for (int i = 0; i < parts; ++i) {
    Real low = a + (b - a) * i / parts, high = a + (b - a) * (i + 1) / parts;
    const bool begins_above = f(low) > 0;
    if (begins_above == (f(high) > 0)) continue;
    for (int step = 0; step < 140; ++step) {
      const Real middle = (low + high) / 2;
      ((f(middle) > 0) == begins_above ? low : high) = middle;
    }
    found.push_back(low);
  }
  return found;
}

/// A curve over [0, 1] with its speed, radius linear in the parameter: nodes between the ends of the support, or
/// in pieces no longer than their distance.
template <class Real, class At>
Sums<Real> curve(const Kernel& kernel, const V<Real>& p, const Real& speed, const Real& tau0, const Real& tau1,
                 const At& at) {
  Sums<Real> sum;
  const auto tau_at = [&](const Real& u) { return Real(tau0 + (tau1 - tau0) * u); };
  const auto visit = [&](const Real& u, const Real& weight) {
    sum.add(kernel, 1, p - at(u), tau_at(u), Real(weight * speed));
  };
  if (kernel.family == KernelFamily::Compact) {
    const Real R = kernel.shape;
    const auto inside = [&](const Real& u) {
      const V<Real> v = p - at(u);
      return Real(R * R * tau_at(u) * tau_at(u) - dot(v, v));
    };
    std::vector<Real> ends{Real(0)};
    for (const Real& root : sign_changes(Real(0), Real(1), inside)) ends.push_back(root);
    ends.push_back(Real(1));
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      if (inside((ends[i] + ends[i + 1]) / 2) > 0) over_with_roots<Real>(ends[i], ends[i + 1], 12, visit);
  } else {
    const Real softening = kernel.family == KernelFamily::Cauchy ? Real(1) / (2 * Real(kernel.shape)) : Real(0);
    over_pieces<Real>(
        Real(0), Real(1),
        [&](const Real& a, const Real& b) {
          const Real length = (b - a) * speed, near = size_of(V<Real>(p - at((a + b) / 2))) - length / 2;
          const Real least = std::min(tau_at(a), tau_at(b)), most = std::max(tau_at(a), tau_at(b));
          return length <= near + softening * least && most - least <= least && length <= 1 + near;
        },
        visit);
  }
  sum.scale(1 / normalisation<Real>(kernel, 1));
  return sum;
}

template <class Real>
Sums<Real> field(const PointSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  Sums<Real> sum;
  sum.add(kernel, 0, vector_of<Real>(p) - vector_of<Real>(s.at), Real(s.radius), Real(1));
  sum.scale(1 / normalisation<Real>(kernel, 0));
  return sum;
}
template <class Real>
Sums<Real> field(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  const V<Real> from = vector_of<Real>(s.from), along = vector_of<Real>(s.to) - from;
  return curve<Real>(kernel, vector_of<Real>(p), size_of(along), Real(s.radius_from), Real(s.radius_to),
                     [&](const Real& u) { return from + along * u; });
}
template <class Real>
Sums<Real> field(const ArcSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  using std::cos;
  using std::sin;
  const V<Real> center = vector_of<Real>(s.center), x = vector_of<Real>(s.axis1), y = vector_of<Real>(s.axis2);
  const Real major = s.major, begin = s.begin, sweep = Real(s.end) - begin;
  return curve<Real>(kernel, vector_of<Real>(p), Real(major * sweep), Real(s.radius_from), Real(s.radius_to),
                     [&](const Real& u) {
                       const Real angle = begin + sweep * u;
                       return center + x * Real(major * cos(angle)) + y * Real(major * sin(angle));
                     });
}

/// A triangle cut in four until its pieces are short against their distance; each by a collapsed square.
template <class Real>
class TriangleSum {
 public:
  TriangleSum(const TriangleSkeleton& s, const Vec3d& p, const Kernel& kernel)
      : kernel_(kernel), p_(vector_of<Real>(p)) {
    Corner c[3];
    for (std::size_t i = 0; i < 3; ++i) c[i] = {vector_of<Real>(s.vertices[i]), Real(s.radii[i])};
    add(c[0], c[1], c[2], 0);
    sum_.scale(1 / normalisation<Real>(kernel, 2));
  }
  const Sums<Real>& sums() const { return sum_; }

 private:
  struct Corner {
    V<Real> at;
    Real tau;
    friend Corner between(const Corner& a, const Corner& b) { return {(a.at + b.at) / Real(2), (a.tau + b.tau) / 2}; }
  };
  void add(const Corner& a, const Corner& b, const Corner& c, int depth) {
    const Real longest =
        std::max({size_of(V<Real>(a.at - b.at)), size_of(V<Real>(b.at - c.at)), size_of(V<Real>(c.at - a.at))});
    const Real near = size_of(V<Real>(p_ - (a.at + b.at + c.at) / Real(3))) - longest;
    const Real least = std::min({a.tau, b.tau, c.tau}), most = std::max({a.tau, b.tau, c.tau});
    const Real softening = kernel_.family == KernelFamily::Cauchy ? Real(least / (2 * kernel_.shape)) : Real(0);
    if (depth < 14 && !(longest <= near + softening && most - least <= least)) {
      const Corner ab = between(a, b), bc = between(b, c), ca = between(c, a);
      add(a, ab, ca, depth + 1);
      add(ab, b, bc, depth + 1);
      add(ca, bc, c, depth + 1);
      add(ab, bc, ca, depth + 1);
      return;
    }
    static const Rule<Real> r(16);
    const V<Real> u = b.at - a.at, v = c.at - b.at;
    const Real area = size_of(V<Real>(cross(u, v)));
    for (std::size_t i = 0; i < r.nodes.size(); ++i)
      for (std::size_t j = 0; j < r.nodes.size(); ++j) {
        const Real &x = r.nodes[i], y = r.nodes[i] * r.nodes[j];
        sum_.add(kernel_, 2, p_ - (a.at + u * x + v * y), Real(a.tau + (b.tau - a.tau) * x + (c.tau - b.tau) * y),
                 Real(r.weights[i] * r.weights[j] * area * x));
      }
  }

  Kernel kernel_;
  V<Real> p_;
  Sums<Real> sum_;
};
/// A triangle under the compact kernel: lines parallel to the edge across from its first vertex, each cut where the
/// support ends, and between those where what a line meets of the support changes.
template <class Real>
class CompactTriangleSum {
 public:
  CompactTriangleSum(const TriangleSkeleton& s, const Vec3d& p, const Kernel& kernel)
      : kernel_(kernel),
        from_(vector_of<Real>(s.vertices[0]) - vector_of<Real>(p)),
        u_(vector_of<Real>(s.vertices[1]) - vector_of<Real>(s.vertices[0])),
        v_(vector_of<Real>(s.vertices[2]) - vector_of<Real>(s.vertices[1])),
        tau_(s.radii[0]),
        tau_u_(Real(s.radii[1]) - s.radii[0]),
        tau_v_(Real(s.radii[2]) - s.radii[1]) {
    const Real area = size_of(V<Real>(cross(u_, v_)));
    for_each_piece(Real(0), Real(1), changes(), [&](const Real& a, const Real& b) {
      over_with_roots<Real>(a, b, 2, [&](const Real& x, const Real& weight) { add_line(x, Real(weight * area)); });
    });
    sum_.scale(1 / normalisation<Real>(kernel, 2));
  }
  const Sums<Real>& sums() const { return sum_; }

 private:
  // R^2 tau^2 - |v|^2 at from + x u + y v, for a given x: a y^2 + b y + c, above 0 inside the support.
  struct Quadratic {
    Real a, b, c;
    Real at(const Real& y) const { return (a * y + b) * y + c; }
    Real discriminant() const { return b * b - 4 * a * c; }
  };
  Quadratic inside(const Real& x) const {
    const V<Real> at = from_ + u_ * x;
    const Real tau = tau_ + tau_u_ * x, R2 = Real(kernel_.shape) * kernel_.shape;
    return {R2 * tau_v_ * tau_v_ - dot(v_, v_), 2 * (R2 * tau * tau_v_ - dot(at, v_)), R2 * tau * tau - dot(at, at)};
  }
  // The edge of the support crosses the two edges that lines begin and end at, or touches a line.
  std::vector<Real> changes() const {
    std::vector<Real> all;
    const auto add = [&](const auto& f) {
      for (const Real& x : sign_changes(Real(0), Real(1), f)) all.push_back(x);
    };
    add([&](const Real& x) { return inside(x).at(Real(0)); });
    add([&](const Real& x) { return inside(x).at(x); });
    add([&](const Real& x) { return inside(x).discriminant(); });
    std::sort(all.begin(), all.end());
    return all;
  }
  template <class Visit>
  static void for_each_piece(const Real& a, const Real& b, const std::vector<Real>& cuts, const Visit& visit) {
    Real begin = a;
    for (const Real& cut : cuts) {
      if (!(cut > begin && cut < b)) continue;
      visit(begin, cut);
      begin = cut;
    }
    visit(begin, b);
  }
  void add_line(const Real& x, const Real& weight) {
    using std::sqrt;
    const Quadratic q = inside(x);
    std::vector<Real> ends;
    if (const Real d = q.discriminant(); d > 0)
      for (const int sign : {-1, 1}) ends.push_back((-q.b + sign * sqrt(d)) / (2 * q.a));
    std::sort(ends.begin(), ends.end());
    for_each_piece(Real(0), x, ends, [&](const Real& a, const Real& b) {
      if (!(q.at((a + b) / 2) > 0)) return;
      over_with_roots<Real>(a, b, 1, [&](const Real& y, const Real& w) {
        sum_.add(kernel_, 2, (from_ + u_ * x + v_ * y) * Real(-1), Real(tau_ + tau_u_ * x + tau_v_ * y),
                 Real(weight * w));
      });
    });
  }

  Kernel kernel_;
  V<Real> from_, u_, v_;
  Real tau_, tau_u_, tau_v_;
  Sums<Real> sum_;
};
template <class Real>
Sums<Real> field(const TriangleSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family == KernelFamily::Compact) return CompactTriangleSum<Real>(s, p, kernel).sums();
  return TriangleSum<Real>(s, p, kernel).sums();
}

}  // namespace marrow::test::oracle
