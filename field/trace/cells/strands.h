// The strands of a blend whose angle follows their directions, as cubes see them.
//
// alpha = sum_{i != j} f_i f_j gamma_ij / sum_{i != j} f_i f_j [Zanni et al. 2015, eq. 15], gamma_ij by the directions
// of two strands, each the mean of its segments' weighted by their fields. Strands that a quadratic over a cube tells
// well enough are one quadratic together, of the tensor sum f u^8 and of three sums, through which they meet the others
// in a time linear in their number (strand_tensor.h). Of each other strand the pieces that a quadratic would not tell
// count one by one, and what is left is a quadratic of f and of sum f_s u_s. Well enough is judged by what is left out
// over the field of all strands but the strongest, as alpha is a mean over pairs. Quadratics are fitted at 15 places of
// the cube. Where strands have angles of their own, gamma_ij is a mean of both, and what is folded is told a second
// time, weighted by them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/shares/angle_field.h"
#include "field/trace/sources/pieces.h"

namespace marrow {

class Tile;
struct BlendField;

/// The quadratics of a tensor and of what goes with it.
inline constexpr std::size_t quadratics_of_tensor = static_cast<std::size_t>(quadratic_monomials) * tensor_floats;

/// What a cube sees of the strands.
struct StrandView {
  std::vector<std::uint32_t> near;  ///< those that count one by one; of a cell whose others are weak none
  /// All others: tensor_floats for each monomial, in the coordinates of the cube. Where strands have angles of their
  /// own, as many again, of sums weighted by them.
  std::vector<float> far;
  double others = 0;  ///< the field of all strands but the strongest in its middle
  std::size_t strongest = std::numeric_limits<std::size_t>::max();  ///< that one, if it counts one by one
  double error = 0;  ///< of the fields of strands, because of quadratics: an estimate

  /// alpha is a mean over pairs, and what one strand is off counts against the field of all but the strongest.
  double share_error() const { return others > 0 ? error / others : 0; }
};

/// A near strand in a cell.
struct NearStrand {
  std::vector<std::uint32_t> listed;         ///< pieces that count one by one
  float rest[4 * quadratic_monomials] = {};  ///< of the others, StrandLevel::rest
};

/// What a cell sees.
struct CellStrands {
  StrandView view;
  std::vector<NearStrand> near;  ///< view.near, in its order
  std::vector<float> far;        ///< StrandLevel::far, and behind it far_weighted
  bool is_weak = false;          ///< BlockLevel::is_weak
};

/// Immutable; safe to use from many threads.
class Strands {
 public:
  /// `pieces` in the order of the tree, whose indices are used. No point is of the strand of others. Refers to both.
  Strands(const BlendField&, std::span<const Piece> pieces, const BlockKernels&);

  /// Of the segment that a piece is part of; 0 of a point.
  Vec3d direction(std::uint32_t piece) const;

  /// What the cell with this middle and half side sees, which lies in the tile; lengths in those of the blend.
  CellStrands around(const Tile&, const Vec3d& center, double half) const;

  /// Of the field of each other strand what one piece may be off.
  static double budget_of(const StrandView&);
  const BlendField& blend() const { return blend_; }
  const AngleRange& range() const { return range_; }
  /// Whether they differ by more than where they are.
  bool have_own_angles() const { return !angles_.empty(); }
  /// As StrandLevel says. Precondition: they have their own.
  const StrandAngle& angle_of_strand(std::uint32_t strand) const { return angles_[strand]; }
  const StrandAngle& angle_of_piece(std::uint32_t piece) const { return angles_[strand_of_[piece]]; }

 private:
  struct Strand {
    Vec3d origin;
    double scale = 0;  // of its groups: 1 / a radius of it
    std::size_t first = 0;
    int count = 0;  // of groups
    bool is_point = false;
    std::vector<std::uint32_t> pieces;  // in ascending order
  };
  struct Cube;
  struct Seen;
  struct alignas(64) Group {
    float at[3][lanes], weight[lanes], direction[3][lanes], length[lanes], taper[lanes];
  };
  static_assert(sizeof(Group) == floats_per_strand_group * sizeof(float));

  void find_own_angles();
  void add_nodes(const Piece&, std::uint32_t index, int& lane);
  std::size_t tensor_count() const { return have_own_angles() ? 2 : 1; }
  void add_to_tensors(std::uint32_t strand, const StrandSamples&, std::vector<float>& values) const;
  const StrandView& around(const Tile&) const;
  StrandView view_of(const Cube&, const Tile* around, std::size_t most, std::vector<float>& values) const;
  bool is_weak(double others) const;
  std::vector<Seen> seen_from(const Cube&, const StrandView* parent) const;
  StrandQuery query(std::uint32_t strand, const Cube&) const;
  Seen see(std::uint32_t strand, const Cube&) const;
  std::vector<bool> to_fold(const std::vector<Seen>&, double others, std::size_t most) const;
  // Leaves at most `most` to count one by one. `values`: of each tensor, at the places of the cube.
  StrandView fold(const std::vector<Seen>&, const Cube&, const Tile* from, std::size_t most,
                  std::vector<float>& values) const;
  // Adds what the rest is off to the error of the view.
  NearStrand divided(std::uint32_t strand, const Cube&, StrandView&) const;

  const BlendField& blend_;
  std::span<const Piece> pieces_;
  const BlockKernels& kernels_;
  int degree_;
  AngleRange range_;
  std::vector<StrandAngle> angles_;                    // of each strand, where they have their own
  bool is_alone_ = true;                               // there are no two strands
  std::vector<std::uint32_t> strand_of_, first_node_;  // of each piece; the lane of its first node in its strand
  std::vector<Strand> strands_;
  std::vector<Group> groups_;
};

}  // namespace marrow
