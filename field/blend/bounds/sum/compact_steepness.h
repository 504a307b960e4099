// The largest derivatives of the compact kernel on a part of its support; internal to blend/.
#pragma once

#include <algorithm>
#include <cmath>

#include "field/kernel/profile.h"
#include "field/math/elementary.h"

namespace marrow {

/// Of w^h, w = 1 - x^2/R^2, h = m/2, over the scaled position, each largest at the largest w that is asked for or where
/// it turns.
class CompactSteepness {
 public:
  /// Where 0 <= w <= most.
  CompactSteepness(const Profile& profile, double R, double most)
      : h_(0.5 * profile.degree()),
        twice_h_(profile.degree()),
        R_(R),
        w_(most),
        scale_((1 + 1e-9) / profile.normalisation()) {}

  /// 2h/R times (1-w)^(1/2) w^(h-1), which rises up to w = (2h-2) / (2h-1).
  double first() const {
    const double w = std::min(w_, (twice_h_ - 2) / (twice_h_ - 1.0));
    return scale_ * 2 * h_ / R_ * std::sqrt(1 - w) * half_power(w, twice_h_ - 2);
  }

  /// h >= 2: 2h/R^2 times w^(h-1) across and w^(h-2) (2h-2 - (2h-1) w) along, which rises up to w = 2 (h-2) / (2h-1),
  /// then falls, and below 0 is no longer than the other.
  double second() const {
    const double w = std::min(w_, 2 * (h_ - 2) / (2 * h_ - 1));
    const double along = half_power(w, twice_h_ - 4) * (2 * h_ - 2 - (2 * h_ - 1) * w);
    return scale_ * 2 * h_ / (R_ * R_) * std::max(half_power(w_, twice_h_ - 2), along);
  }

  /// h >= 3: along a line at the angle of cosine c from that to the skeleton 12 h (h-1)/R^3 times (1-w)^(1/2) w^(h-3)
  /// (c w - b (1-w) c^3), b = 2/3 (h-2). It bounds what second derivatives change by, also across the edge.
  double third() const {
    return scale_ * 12 * h_ * (h_ - 1) / (R_ * R_ * R_) * std::max(third_aslant(), third_along());
  }

 private:
  // At c^2 = w / (3 b (1-w)), as far as that is below 1: it rises with w.
  double third_aslant() const {
    const double w = std::min(w_, 2 * (h_ - 2) / (2 * h_ - 3));
    return 2.0 / 3 * half_power(w, twice_h_ - 3) / std::sqrt(2 * (h_ - 2));
  }

  // At c = 1: (1-w)^(1/2) w^k (b - (b+1) w), k = h-3, turns at the roots of
  //   (2k+3) (b+1) w^2 - (b + 2 (b+1) + 2k (2b+1)) w + 2k b.
  double third_along() const {
    const double b = 2.0 / 3 * (h_ - 2), k = h_ - 3, square = (2 * k + 3) * (b + 1);
    const double half = 0.5 * (b + 2 * (b + 1) + 2 * k * (2 * b + 1));
    const double spread = std::sqrt(std::max(0.0, half * half - square * 2 * k * b));
    double most = 0;
    for (const double w : {0.0, w_, (half - spread) / square, (half + spread) / square})
      if (w <= w_) most = std::max(most, std::sqrt(1 - w) * half_power(w, twice_h_ - 6) * std::fabs(b - (b + 1) * w));
    return most;
  }

  double h_;
  int twice_h_;
  double R_, w_, scale_;
};

}  // namespace marrow
