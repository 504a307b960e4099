// Bounds of the sums f and S = grad_S f of a blend and of their derivatives over a small box.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "field/blend/blend_field.h"
#include "field/blend/bounds/sum/distance_slopes.h"
#include "field/blend/bounds/sum/distances_in_reach.h"
#include "field/blend/primitive_bounds.h"
#include "field/blend/sources/far_polynomial.h"
#include "field/blend/sources/source_sums.h"
#include "field/math/box3.h"
#include "field/number/interval.h"

namespace marrow {

/// A way through a box, from its middle to either end, as rays take it, straight or nearly so; lengths as those of the
/// box.
struct Stretch {
  Vec3d half;       ///< from the middle to one end; the other lies as far on the other side
  Vec3d direction;  ///< parallel to `half`: what slopes along it are for
  double slack;     ///< by which its places may lie off, as the way bends and they are rounded
  double turn = 0;  ///< by which what slopes are for may differ from `direction`
};

/// What a box becomes that is turned and stretched: its middle and, from there, the ways to the middles of three faces.
struct SkewBox {
  std::array<Vec3d, 3> halves;
  double slack;  ///< by which its places may lie off

  /// No place is farther from the middle.
  double radius() const;
};

/// The places that count, about the middle of a box that holds them: all of it, or only those of one of these.
struct Within {
  const Stretch* stretch = nullptr;
  const SkewBox* skew = nullptr;

  Within() = default;
  Within(const Stretch* s) : stretch(s) {}
  Within(const SkewBox* s) : skew(s) {}
};

/// What is asked for: slopes of primitives by distance cost more than all else.
enum class Wanted { Value, Slopes };

/// Sums over primitives of an exact sample in the middle of the box and of what it may change by on the way to any
/// point of the box, which follows from the least distance of each primitive.
class SumBounds {
 public:
  /// Relative error of the closed forms, with a margin of ten.   [seen: 1.2e-13; triangles 2.6e-12]
  static constexpr double sample_error = 3e-11;
  /// Relative error of integrals under the compact kernel, over what they could be at most.
  static constexpr double compact_error = 1e-10;

  explicit SumBounds(const Box3&, const Within& = {});
  /// Of places in the box, or only of those within something in it.
  SumBounds(const BlendField&, const Box3&, Wanted = Wanted::Slopes, const Within& = {});

  /// A primitive that is a positive sum of |p - q|^-m with all q at least `distance` away from the middle and radii up
  /// to `radius`. Its k-th derivatives are at most m (m+1) ... (m+k-1) / distance^k times itself, and within rho of the
  /// middle all distances shrink by 1 - rho / distance at most.   [taylor_remainder.h]
  void add(const SkeletonSample&, double distance, double radius, int m);
  /// A primitive of which only bounds are known.
  struct Between {
    Interval f;
    Vec3d S{};         ///< its scale-invariant gradient is this
    double S_by = 0;   ///< up to a vector of this length
    double log_slope;  ///< of |grad ln f|
    std::optional<PrimitiveSlopes> slopes{};
    bool S_jumps = false;      ///< then its slopes are of f alone
    bool is_on_curve = false;  ///< |S| is g(f): of primitives by distance
  };
  void add(const Between&);
  /// A primitive of which the largest first and second derivatives anywhere are known, up to a radius; and how far
  /// places are from the middle across it, where along it only its ends tell anything.
  struct Smooth {
    double steepest, most_bent, radius;
    double across;
    double J_changes;                          ///< by which J may differ between the middle and any place as far across
    double S_beyond_J;                         ///< and S there from what J in the middle tells
    double ends_bent = 0, ends_J_changes = 0;  ///< what ends add to its second derivatives, and to J over a length
  };
  void add(const SkeletonSample&, const Smooth&);
  /// Sources: the same from one remainder for all of them.
  void add(const SourceSums&);
  /// The box lies in its ball.
  void add(const FarPolynomial&);

  /// What is known of one primitive in the ball of `rho` around the middle.
  using Part = PrimitiveBounds;
  /// All primitives of a blend whose angle is a mean over its skeletons or strands, in the order of visit_parts().
  const std::vector<Part>& parts() const { return parts_; }
  /// The parts of each strand by distance of which more than one segment may be the largest: where one takes over from
  /// another, angles and directions jump.
  const std::vector<std::vector<std::size_t>>& takeovers() const { return takeovers_; }

  const Box3& box() const { return box_; }
  const Vec3d& center() const { return center_; }
  /// No place that counts is farther from the middle: half the diagonal of the box, or less.
  double rho() const { return rho_; }
  /// A skeleton is so near that f has no upper bound.
  bool unbounded() const { return unbounded_; }
  Interval f() const;
  /// Whether gradient() is bounded, and J() too.
  bool has_gradient() const { return has_gradient_ && !unbounded_; }
  bool has_slopes() const { return has_slopes_ && has_gradient(); }
  /// Nothing but one primitive by distance has a field in the box, so that the operator leaves f as it is, where it
  /// leaves lone skeletons alone.
  bool is_on_curve() const { return added_ == 1 && on_curve_ == 1; }
  Vec3<Interval> gradient() const;
  Vec3<Interval> S() const;
  /// |S| at most, by the size of each primitive's, where f is bounded.
  double longest_S() const { return most_.S * (1 + 1e-9); }
  /// d S_i / d p_j
  Interval J(std::size_t i, std::size_t j) const;
  /// The stretch, if it is all that is asked for; then slopes of f and of S_i along its direction.
  const Stretch* stretch() const { return stretch_ ? &*stretch_ : nullptr; }
  Interval f_along() const;
  Interval S_along(std::size_t i) const;
  /// Largest |grad ln f_i| of any primitive anywhere in the box.
  double log_slope() const { return log_slope_; }

 private:
  /// What f and |S| of what is summed come to at most.
  struct Most {
    double f = 0, S = 0;
  };
  void add(const Most&);
  void keep(const Part& part) {
    if (keeps_parts_) parts_.push_back(part);
  }
  Interval change(const Vec3d& slope) const;
  template <class Skeleton, class Sample>
  void add_integral(const BlendField&, const Skeleton&, double distance, int m, const Sample&);
  void add_inverse(const BlendField&);
  void add_cani_hornus(const BlendField&);
  void add_cauchy(const BlendField&);
  void add_compact(const BlendField&);
  void add_distances(const BlendField&);
  void add_strands(const BlendField&);
  void keep_strand(std::size_t size, std::span<const SeenSegment>, std::span<const Part>);

  Box3 box_;
  std::optional<Stretch> stretch_;
  std::optional<SkewBox> skew_;  ///< of a stretch, too
  Vec3d center_;
  double rho_;
  double f_ = 0, low_ = 0, error_ = 0, slope_error_ = 0, S_error_ = 0, second_ = 0, S_second_ = 0, log_slope_ = 0;
  double J_error_ = 0;
  Vec3d gradient_{}, S_{};
  Matrix3 J_{};
  Most most_;
  PrimitiveSlopes between_{};
  bool unbounded_ = false, has_gradient_ = true, has_slopes_ = true, keeps_parts_ = false;
  std::size_t added_ = 0, on_curve_ = 0;
  std::vector<Part> parts_;
  std::vector<std::vector<std::size_t>> takeovers_;
};

}  // namespace marrow
