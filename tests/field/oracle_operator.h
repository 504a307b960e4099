// The correction operator by its definition, in any precision: what oracle.h is to fields.
#pragma once

#include <algorithm>
#include <cmath>

namespace marrow::test::oracle {

/// The operator for the inverse kernel by its definition: eq. 12 as printed, or the root on the curve by halving;
/// the curve M_d through (f, G) and its steepest point by halving too. alpha in [0, pi/2).
template <class Real>
class Operator {
 public:
  Operator(int n, const Real& alpha, bool cavity, bool exact) : n_(n), cavity_(cavity), exact_(exact) {
    using std::tan;
    tan_ = tan(alpha);
  }
  Real value(const Real& f, const Real& G) const {
    using std::pow;
    if (!cavity_) return projected(f, G);
    // two unit skeletons 2a apart at height h: f = 2 r^-(n-1), G = 2 (n-1) r^-(n+1) h
    const Real r = pow(Real(f / 2), Real(Real(-1) / (n_ - 1))), h = G * pow(r, Real(n_ + 1)) / (2 * (n_ - 1));
    if (h >= r) return projected(f, G);
    const Real a2 = r * r - h * h;
    // slope of M_d by f at height y: (dG/dy) / (df/dy)
    const auto falls_faster = [&](const Real& y) {
      const Real r2 = a2 + y * y, slope = (1 - (n_ + 1) * y * y / r2) / -y;
      return -slope > tan_;
    };
    if (!falls_faster(h)) return projected(f, G);
    Real low = h, high = h + 10 * r;
    for (int step = 0; step < 160; ++step) {
      const Real middle = (low + high) / 2;
      (falls_faster(middle) ? low : high) = middle;
    }
    const Real r_D = sqrt_of(Real(a2 + low * low));
    return projected(Real(2 * pow(r_D, Real(1 - n_))), Real(2 * (n_ - 1) * pow(r_D, Real(-n_ - 1)) * low));
  }

 private:
  static Real sqrt_of(const Real& x) {
    using std::sqrt;
    return sqrt(x);
  }
  Real curve(const Real& f) const {
    using std::pow;
    return (n_ - 1) * pow(f, Real(Real(n_) / (n_ - 1)));
  }
  Real projected(const Real& f, const Real& G) const {
    using std::pow;
    const Real x_H = pow(Real(G / (n_ - 1)), Real(Real(n_ - 1) / n_));
    if (!exact_) {
      const Real l_H = f - x_H, l_V = curve(f) - G;
      return f - l_H * l_V / (l_V + l_H * tan_);
    }
    Real low = std::min(f, x_H), high = std::max(f, x_H);
    for (int step = 0; step < 160; ++step) {
      const Real middle = (low + high) / 2;
      (curve(middle) + middle * tan_ < G + f * tan_ ? low : high) = middle;
    }
    return low;
  }

  int n_;
  bool cavity_, exact_;
  Real tan_;
};

}  // namespace marrow::test::oracle
