// Which sources a cube must list, and which it may fold into its far field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/sources/far_field.h"
#include "field/trace/sources/kept_far_field.h"
#include "field/trace/sources/pieces.h"
#include "field/trace/sources/quadrature.h"
#include "field/trace/sources/source_tree.h"

namespace marrow {

class SourceGroups;

using PieceIndex = std::uint32_t;

/// All sources as one cube sees them: a list of the near ones, and polynomials for the rest.
struct Surroundings {
  std::vector<SourceRef> near;
  FarField far;
};

/// The same, for the cubes below.
struct KeptSurroundings {
  std::vector<SourceRef> near;
  KeptFarField far;

  KeptSurroundings() = default;
  explicit KeptSurroundings(Surroundings s) : near(std::move(s.near)), far(s.far) {}
  /// Without the object itself.
  std::size_t bytes() const { return near.capacity() * sizeof(SourceRef) + far.bytes(); }
};

/// Whether near sources that hardly count in a cube are left out of its list.
enum class Slight { Kept, LeftOut };

/// The share of the total error that one piece, or one group of pieces, may cause in f and in |grad_S f|.
struct ErrorBudget {
  double field, gradient;
};

/// Splits at certified errors: the remainders of taylor_remainder.h and the quadrature bound of GaussError, and for a
/// group that stands for its pieces the second moments that its centre of mass neglects.
class NearFar {
 public:
  /// `far_degree`: of the polynomials, low_far_degree, high_far_degree or highest_far_degree.
  NearFar(int degree, ErrorBudget, const BlockKernels&, int far_degree);
  int degree() const { return degree_; }
  int far_degree() const { return far_degree_; }
  const ErrorBudget& budget() const { return budget_; }

  /// Adds the far ones of `candidates` to `far` (in the coordinates of the cube) and returns the near ones: curves,
  /// then points, in their order.
  /// With `slight`, near ones whose whole field in the cube is within the budget are left out, as an error of `far`.
  std::vector<PieceIndex> split(std::span<const Piece>, std::span<const PieceIndex> candidates, const Vec3d& center,
                                double half, FarField& far, Slight = Slight::Kept) const;

  /// The same for sources of a tree; groups are opened until they are far, or no larger than `keep` times `half`.
  /// Adds the far ones to `far` and returns the near ones, groups first. With open_all what is slight is left out:
  /// lists that are passed on to smaller cubes keep it, where it may be far.
  std::vector<SourceRef> split(const SourceTree&, std::span<const SourceRef> candidates, const Vec3d& center,
                               double half, double keep, FarField& far) const;

  static constexpr double open_all = -1;  ///< as `keep`

  using Rule = GaussError::Rule;
  /// The smallest rule whose error at this distance is within `share` of the budget, else the largest.
  Rule rule_for(const Piece&, double distance, double share) const;

 private:
  struct Remainders {
    double field, gradient;
    Remainders times(double share) const { return {share * field, share * gradient}; }
  };
  Remainders remainders(bool point, double q) const;
  struct FarGroups;
  // Whether a group is one; then its errors are added to those of `far`.
  bool counts_as_far(const SourceNode&, const Vec3d& place, double cube_radius, FarField& far) const;
  bool counts_as_slight(const SourceNode&, double distance, double cube_radius, FarField& far) const;
  bool add_if_far(const SourceNode&, FarGroups&) const;
  void fold(const FarGroups&) const;
  FarQuery query(bool points, Slight, bool some_lean) const;
  void add_sums(const FarSums&, bool points, FarField&) const;
  double sum_rounding() const;

  static constexpr int table_size = 256;
  static constexpr double largest_ratio = 0.5;  ///< of cube radius to distance: beyond it nothing is far
  int degree_, far_degree_;
  ErrorBudget budget_;
  const BlockKernels& kernels_;
  GaussError quadrature_;
  MomentTable curve_moments_, point_moments_;
  std::vector<Remainders> curve_, point_;  // psi at ratios i / table_size * largest_ratio
};

/// What an octant of a cube sees, given what the cube sees; without a parent: what a cube sees of all sources. `keep`
/// as in NearFar::split(); `octant` has a bit for each axis.
Surroundings refined(const NearFar&, const SourceTree&, const KeptSurroundings* parent, int octant, const Vec3d& center,
                     double half, double keep);

/// Emits the nodes of the rule with `count` of them, 1 to max_gauss_nodes, or a point, in the coordinates of a cube.
void add_nodes(const Piece&, int count, const Vec3d& center, double half, int degree, SourceGroups& out);

}  // namespace marrow
