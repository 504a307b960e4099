// How fast the angle by the directions of strands changes in a ball; internal to blend/.
#pragma once

#include <vector>

#include "field/blend/bounds/angle/field_weight.h"

namespace marrow {

/// The direction of a skeleton in the middle, of a length of at most 1, and by how much those of its places differ.
struct SkeletonDirection {
  Vec3d mean{};
  double range = 0;
  double turn = 0;  ///< by distance: how fast that of the nearest place turns, at most
};

/// A strand while its skeletons are added.
class StrandTerms {
 public:
  explicit StrandTerms(double rho = 0) : rho_(rho) {}
  /// The part has to live as long.
  void add(const SumBounds::Part&, const SkeletonDirection&);
  bool empty() const { return all_.empty(); }

 private:
  friend struct StrandBounds;
  struct Item {
    const SumBounds::Part* part;
    FieldWeight weight;
    SkeletonDirection direction;
  };
  Vec3d common_slope() const;
  FieldWeight weight(const Vec3d& common, const std::vector<MeanTerm>& terms) const;
  bool is_straight() const;
  MeanChange turn_of(const Vec3d& mean, std::vector<MeanTerm> terms) const;

  double rho_;
  std::vector<Item> all_;
  double value_ = 0;  // of the sum of the fields
  bool is_log_ = true;
};

/// Its field and its direction u, of length 1 or 0.
struct StrandBounds {
  FieldWeight weight;
  Vec3d u{};
  MeanChange turn{};  ///< of u in the ball; infinite where it may have no direction
  DirectionBounds angles;

  /// Of a strand that is not empty.
  static StrandBounds of(const StrandTerms&, const DirectionBounds&);
};

/// Of alpha = sum f_i f_j gamma_ij / sum f_i f_j, which is `alpha` in the middle and nowhere farther than `widest` from
/// any gamma. Strands in falling order of their weights.   [Zanni et al. 2015, eq. 15]
MeanChange angle_change(const std::vector<StrandBounds>&, double alpha, double widest, double rho);

}  // namespace marrow
