// Sums over weighted points, which is what integrals over skeletons become at a distance from them.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "field/blend/sources/mark_sums.h"
#include "field/kernel/inverse_family.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// A point q with f = w D^-m and grad_S f = grad (w tau D^-m), D^2 = |p - q|^2 + lift^2: a node of a rule for the
/// inverse kernel, or, with a lift of tau / scale, for the Cauchy kernel.
struct Source {
  Vec3d at;
  double weight = 0, radius = 0, lift_squared = 0;
  double mark = 0;  ///< of its skeleton, where a blend has marks (mark_sums.h)
};

/// Sums and what bounds their remainders.   [taylor_remainder.h]
struct SourceSample {
  SkeletonSample sum;
  double second = 0;                                         ///< sum w D^-(m+2)
  double pull = 0;                                           ///< sum w tau D^-(m+2)
  double third = 0;                                          ///< sum w tau D^-(m+3)
  double nearest = std::numeric_limits<double>::infinity();  ///< least D
};

/// Sources of one exponent m. The same bits on every instruction set.
class SourceSums {
 public:
  /// Precondition: exponent >= 2. `marked`: whether marks are kept.
  explicit SourceSums(int exponent, bool marked = false) : exponent_(exponent), marked_(marked) {}

  /// Makes room for so many in all.
  void reserve(std::size_t count) {
    groups_.reserve((count + lanes - 1) / lanes);
    if (marked_) marks_.reserve((count + lanes - 1) / lanes);
  }
  void add(const Source&);
  int exponent() const { return exponent_; }
  std::size_t count() const { return count_; }
  bool empty() const { return count_ == 0; }
  /// The i-th that was added.
  Source operator[](std::size_t i) const;
  double largest_radius() const { return largest_radius_; }
  std::size_t bytes() const { return groups_.capacity() * sizeof(Group) + marks_.capacity() * sizeof(Marks); }

  /// All of it at p.
  SourceSample at(const Vec3d& p) const;
  /// Only value and si_gradient.
  SkeletonSample value_at(const Vec3d& p) const;
  /// Precondition: marks are kept.
  MarkSums marks_at(const Vec3d& p) const;
  /// A lower bound of the value within rho of p.
  double least_within(const Vec3d& p, double rho) const;

  static constexpr int lanes = 8;
  struct alignas(64) Group {
    double x[lanes], y[lanes], z[lanes], weight[lanes], radius[lanes], lift_squared[lanes];
  };
  struct alignas(64) Marks {
    double of[lanes];
  };

 private:
  int exponent_;
  bool marked_;
  std::size_t count_ = 0;
  double largest_radius_ = 0;
  std::vector<Group> groups_;
  std::vector<Marks> marks_;  ///< of the groups
};

/// Sources of points, curves and surfaces, which differ in their exponents.
struct SourceLists {
  /// Of a blend of this degree; with marks, or without.
  explicit SourceLists(int degree, bool marked = false)
      : points(kernel_degree(degree, 0), marked),
        curves(kernel_degree(degree, 1), marked),
        surfaces(kernel_degree(degree, 2), marked) {}

  SourceSums points, curves, surfaces;

  SourceSums& with(int exponent) {
    return exponent == points.exponent() ? points : exponent == curves.exponent() ? curves : surfaces;
  }
  std::array<const SourceSums*, 3> all() const { return {&points, &curves, &surfaces}; }
  bool empty() const { return points.empty() && curves.empty() && surfaces.empty(); }
  std::size_t bytes() const { return points.bytes() + curves.bytes() + surfaces.bytes(); }
};

}  // namespace marrow
