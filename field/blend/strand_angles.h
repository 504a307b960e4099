// How fast the angle by the directions of strands changes in a ball; internal to blend/.
#pragma once

#include <vector>

#include "field/blend/log_weight.h"

namespace marrow {

/// The direction of a skeleton in the middle, of a length of at most 1, and how fast it turns in the ball.
struct SkeletonDirection {
  Vec3d mean{};
  MeanChange turn{};
};

/// A strand while its skeletons are added.
class StrandTerms {
 public:
  void add(const LogWeight&, const SkeletonDirection&);
  double weight() const { return weight_; }

 private:
  friend struct StrandBounds;
  struct Item {
    LogWeight weight;
    SkeletonDirection direction;
  };
  std::vector<Item> all_;
  double weight_ = 0;
  Vec3d slopes_{}, direction_{};  // sums over skeletons, by their weights
};

/// Its field and its direction u, of length 1 or 0.
struct StrandBounds {
  LogWeight weight;
  Vec3d u{};
  MeanChange turn{};  ///< of u in the ball; infinite where it may have no direction
  DirectionBounds angles;

  /// Of a strand whose weight is above 0.
  static StrandBounds of(const StrandTerms&, const DirectionBounds&, double rho);
};

/// Of alpha = sum f_i f_j gamma_ij / sum f_i f_j, which is `alpha` in the middle and nowhere farther than `widest` from
/// any gamma. Strands in falling order of their weights.   [Zanni et al. 2015, eq. 15]
MeanChange angle_change(const std::vector<StrandBounds>&, double alpha, double widest, double rho);

}  // namespace marrow
