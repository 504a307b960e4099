// The largest derivatives of the compact kernel on a part of its support; internal to blend/.
#pragma once

#include <algorithm>
#include <cmath>

#include "field/kernel/profile.h"
#include "field/math/elementary.h"

namespace marrow {

/// Of w^h, w = 1 - x^2/R^2, h = m/2, over the scaled position and where 0 <= w <= most:
///   first   2h/R (1-w)^(1/2) w^(h-1)
///   second  2h/R^2 times -w^(h-1) across and w^(h-2) (2h-2 - (2h-1) w) along, which below 0 is no longer than the
///   other third   along a direction that leaves the skeleton at the angle of cosine c, 12 h (h-1)/R^3 times
///           (1-w)^(1/2) w^(h-3) (c w - 2/3 (h-2) (1-w) c^3): no more than the larger of both terms at c = 1
/// each a power of 1-w times one of w, which has one peak.
class CompactSteepness {
 public:
  CompactSteepness(const Profile& profile, double R, double most)
      : h_(0.5 * profile.degree()),
        twice_h_(profile.degree()),
        R_(R),
        w_(most),
        scale_((1 + 1e-9) / profile.normalisation()) {}

  double first() const { return scale_ * 2 * h_ / R_ * term(1, 2); }
  /// h >= 2
  double second() const {
    const double w = std::min(w_, 2 * (h_ - 2) / (2 * h_ - 1));
    const double along = half_power(w, twice_h_ - 4) * (2 * h_ - 2 - (2 * h_ - 1) * w);
    return scale_ * 2 * h_ / (R_ * R_) * std::max(half_power(w_, twice_h_ - 2), along);
  }
  /// h >= 3: from there on it bounds what second derivatives change by, also across the edge.
  double third() const {
    return scale_ * 12 * h_ * (h_ - 1) / (R_ * R_ * R_) * std::max(term(1, 4), 2.0 / 3 * (h_ - 2) * term(3, 6));
  }

 private:
  // sup (1-w)^(a/2) w^(h-b/2): it rises up to w = (2h-b) / (2h-b+a).
  double term(int a, int b) const {
    const double peak = (twice_h_ - b) / static_cast<double>(twice_h_ - b + a), w = std::min(w_, peak);
    return half_power(1 - w, a) * half_power(w, twice_h_ - b);
  }

  double h_;
  int twice_h_;
  double R_, w_, scale_;
};

}  // namespace marrow
