// The strands of a blend whose angle follows their directions, as cubes see them.
//
// alpha = sum_{i != j} f_i f_j gamma_ij / sum_{i != j} f_i f_j [Zanni et al. 2015, eq. 15], gamma_ij by the directions
// of two strands, each the mean of its segments' weighted by their fields. What is near a cube counts piece by piece.
// Of a strand with near pieces the rest is a quadratic of f and of sum f_s u_s; all other strands together are a
// quadratic of the tensor sum f u^8 and of three sums, through which they meet the near ones in a time linear in their
// number (field-maths 7). Quadratics are fitted at 15 places of the cube.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/trace/block_kernels.h"
#include "field/trace/pieces.h"

namespace marrow {

class Tile;
struct BlendField;

/// What a cube sees of the strands.
struct StrandView {
  std::vector<std::uint32_t> near;  ///< counted one by one
  std::vector<float> far;           ///< all others: tensor_floats for each monomial, in the coordinates of the cube
  double error = 0;                 ///< of the share of angles, because of the quadratic: an estimate
};

/// The rest of a strand in a cell, in whose list its near pieces are.
struct StrandRest {
  std::uint32_t strand;
  float sums[4 * quadratic_monomials];  ///< StrandLevel::rest
};

/// What a cell sees.
struct CellStrands {
  StrandView view;                    ///< of the points none that the cell lists
  std::vector<std::uint32_t> points;  ///< pieces that the cell lists, and that are not among the far strands
  std::vector<StrandRest> rest;       ///< of view.near, in its order
  std::vector<float> far;             ///< StrandLevel::far
};

/// Immutable; safe to use from many threads.
class Strands {
 public:
  /// `pieces` in the order of the tree, whose indices are used. No point is of the strand of others.
  Strands(const BlendField&, std::span<const Piece> pieces, const BlockKernels&);

  std::uint32_t strand_of(std::uint32_t piece) const { return strand_of_[piece]; }
  /// Of the segment that a piece is part of; 0 of a point.
  Vec3d direction(std::uint32_t piece) const;

  /// `near`: the pieces that the cell lists, with strands in ascending order.
  CellStrands around(const Tile&, const Vec3d& center, double half, std::span<const std::uint32_t> near) const;

 private:
  struct Strand {
    Vec3d origin;
    double scale = 0;  // of its groups: 1 / a radius of it
    std::size_t first = 0;
    int count = 0;  // of groups
    bool is_point = false;
  };
  struct Cube;
  struct Probed;
  struct alignas(64) Group {
    float at[3][lanes], weight[lanes], direction[3][lanes];
  };
  static_assert(sizeof(Group) == floats_per_strand_group * sizeof(float));

  void add_nodes(const Piece&, std::uint32_t index, int& lane);
  const StrandView& around(const Tile&) const;
  Probed probe(std::uint32_t strand, const Cube&, std::span<const std::uint32_t> left_out) const;
  static std::vector<bool> forced(const std::vector<Probed>&, std::size_t most);
  // Leaves at most `most` to count one by one. `values`: of the tensor, at the places of the cube.
  StrandView fold(std::vector<Probed>&, const Cube&, const StrandView* parent, const Cube& parent_cube,
                  std::size_t most, std::vector<float>& values) const;

  std::span<const Piece> pieces_;
  const BlockKernels& kernels_;
  int degree_;
  std::vector<std::uint32_t> strand_of_, first_node_;  // of each piece; the lane of its first node in its strand
  std::vector<Strand> strands_;
  std::vector<Group> groups_;
};

}  // namespace marrow
