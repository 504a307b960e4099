// The contact angle adapted to the place: to unequal radii, and to how many skeletons meet.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "field/blend/angle/alpha_sample.h"
#include "field/description/field_node.h"
#include "field/number/functions.h"

namespace marrow {

/// What the rule is told about a point.
struct Neighbourhood {
  double field = 0;  ///< f = sum f_i
  Vec3d field_gradient;
  double spread = 0;  ///< 4 times the variance of ln(radius), weighted by f_i: the square of ln(r_1 / r_2) between two
  Vec3d spread_gradient;
  double near_field = 0;  ///< the sum under the kernel of degree `near_degree`, which feels the nearest skeleton only
  Vec3d near_gradient;
};

/// `contact` holds for two equal skeletons. Two others join a little late, because at the point of touch f is 2 but
/// has no minimum there; and where more than two come close, f is larger and they join early. This is the "future work"
/// of Zanni et al. 2015, sec. 6. The rule:
///   alpha(p) = contact + unequal(spread) + dense(crowd), at least alpha of the ring (or 0 where it is not defined),
///   at most pi/2.
///   unequal  makes two balls of any ratio of radii join when they touch: within 2e-4 of the sum of the
///            radii for ratios up to 5, within 2e-3 up to 20 (contact alone: 0.02 and 0.04 late); Cauchy and
///            compact kernels within 2e-3 up to 2.5. 0 for equal radii.
///   crowd    = f / k(e), e the scaled distance of the nearest skeleton as the near field has it: for k equal
///            skeletons around p it is k; for one infinite skeleton 1, however it is cut. dense() is 0 up to 2 and
///            falls as the square beyond, such that in the middle of a ring of thickness r and radius r, a torus that
///            just closes, C = 1. Three and more balls that meet in one point join after they touch.
/// Both are smooth, do not change under scaling, and depend on the skeletons alone.
class LocalContact {
 public:
  static constexpr int near_degree = 20;
  /// Beyond it the near field tells no more than the field itself.
  static constexpr int max_dense_degree = 12;

  /// `density` needs the inverse kernel and a degree of at most max_dense_degree.
  LocalContact(const Kernel&, bool cavity, Projection, bool radii, bool density);

  bool adapts_to_radii() const { return radii_; }
  bool adapts_to_density() const { return density_; }
  double contact() const { return contact_; }
  /// No angle is smaller: that of the ring, which may be below 0, or `contact`.
  double least() const { return least_; }

  AlphaSample at(const Neighbourhood&) const;
  /// The same with second derivatives.
  HessianJet at(const HessianJet& field, const HessianJet& spread, const HessianJet& near_field) const;
  /// How many equal skeletons would make this neighbourhood; 1 where it does not tell.
  double crowd(const Neighbourhood&) const;
  /// All angles there may be.
  const Interval& range() const { return range_; }
  /// All with a spread and a crowd within bounds, and the largest first and second derivatives by these there, but
  /// where it is cut. [the cubic pieces lie in the hull of their control points]
  struct Within {
    Interval alpha;
    double by_spread = 0, by_spread_twice = 0, by_crowd = 0, by_crowd_twice = 0;
    bool may_be_cut = false;  ///< at `least` or at pi/2
  };
  Within within(const Interval& spread, const Interval& crowd) const;
  /// crowd = (field near_field^-share)^exponent.
  double crowd_share() const { return (kernel_.degree - 1) / (near_degree - 1.0); }
  double crowd_exponent() const { return (near_degree - 1.0) / (near_degree - kernel_.degree); }

 private:
  // The table runs over y = s / (1 + s), s the spread, up to a ratio of radii of e^3.
  static constexpr std::size_t entries = 17;
  static constexpr double last_y = 0.9, step = last_y / (entries - 1);

  double crowd_of_ring() const;
  void make_table();
  void fit_ring();
  template <Number X>
  X unequal(const X& spread) const;
  template <Number X>
  X crowd_at(const X& field, const X& near_field) const;
  template <Number X>
  X angle(const X& field, const X& spread, const X& near_field) const;
  struct Unequal {
    Interval angle;
    double steepest = 0, bent = 0;
  };
  // Between two entries, over t in [0, 1].
  struct Piece {
    double at, first, bend, twist;
  };
  Piece piece(std::size_t) const;
  Unequal unequal_within(const Interval& spread) const;

  Kernel kernel_;
  bool cavity_;
  Projection projection_;
  bool radii_, density_;
  double contact_, least_;
  double dense_factor_ = 0;
  std::array<double, entries> angle_{}, slope_{};
  Interval range_;
};

/// The radius by which a skeleton counts in the spread.
inline double mean_radius(const PointSkeleton& s) { return s.radius; }
inline double mean_radius(const SegmentSkeleton& s) { return std::sqrt(s.radius_from) * std::sqrt(s.radius_to); }
inline double mean_radius(const ArcSkeleton& s) { return std::sqrt(s.radius_from) * std::sqrt(s.radius_to); }
inline double mean_radius(const TriangleSkeleton& s) { return (s.radii[0] + s.radii[1] + s.radii[2]) / 3; }

}  // namespace marrow
