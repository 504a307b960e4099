// Pieces in a hierarchy of groups, each with the moments that let it stand for its pieces from afar.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/trace/sources/pieces.h"

namespace marrow {

/// A group of pieces of one kind. Sums run over its sources, w = tau^(n-1) ds / N along a curve and tau^(n-1) at a
/// point; they are exact, because Gauss-Legendre rules are for polynomials.
struct SourceNode {
  Vec3d center;                         ///< sum w q / sum w
  double thinnest = 0;                  ///< least radius of its pieces, each taken at its thicker end
  double radius = 0;                    ///< all of its pieces lie in this ball around the centre
  double mass = 0;                      ///< sum w
  double spread = 0;                    ///< sum w |q - center|^2
  double tau_mass = 0, tau_spread = 0;  ///< the same sums with w tau
  Vec3d tau_shift;                      ///< sum w tau (q - center)
  std::uint32_t begin = 0, end = 0;     ///< its pieces
  std::uint32_t right = 0;              ///< the left child follows its parent, the right one is here; 0: a leaf
  std::uint16_t exponent = 0;           ///< f = sum w d^-exponent
  bool is_point = false;

  bool is_leaf() const { return right == 0; }
};

/// One source, or a group of them, of a tree.
class SourceRef {
 public:
  static SourceRef piece(std::uint32_t i) { return SourceRef(i | piece_bit); }
  static SourceRef node(std::uint32_t i) { return SourceRef(i); }
  bool is_piece() const { return (bits_ & piece_bit) != 0; }
  std::uint32_t index() const { return bits_ & ~piece_bit; }

 private:
  static constexpr std::uint32_t piece_bit = std::uint32_t{1} << 31;
  explicit SourceRef(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_;
};

/// Immutable, safe to use from many threads. Fewer than 2^31 pieces.
class SourceTree {
 public:
  /// Halves the pieces at the median of their longest extent; the same tree on any number of threads.
  SourceTree(std::vector<Piece>, int degree);

  /// In the order of the tree: each node holds a range of them.
  std::span<const Piece> pieces() const { return pieces_; }
  const Piece& piece(std::uint32_t i) const { return pieces_[i]; }
  const SourceNode& node(std::uint32_t i) const { return nodes_[i]; }
  std::span<const SourceNode> nodes() const { return nodes_; }
  /// Of all curves and of all points, as far as there are any.
  std::span<const SourceRef> roots() const { return roots_; }
  std::size_t bytes() const { return pieces_.capacity() * sizeof(Piece) + nodes_.capacity() * sizeof(SourceNode); }

  static constexpr std::size_t leaf_size = 8;

 private:
  std::vector<Piece> pieces_;
  std::vector<SourceNode> nodes_;
  std::vector<SourceRef> roots_;
};

}  // namespace marrow
