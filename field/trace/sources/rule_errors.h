// How far off Gauss-Legendre rules are for a piece of skeleton, as found on the border of where they are asked.
#pragma once

#include <array>
#include <cstddef>

#include "field/base/lazy.h"

namespace marrow {

/// The largest errors of the rule with `nodes` nodes for
///   1/2 int_-1^1 w(s) d(s)^-n ds   and   n/2 int_-1^1 w(s) (p-q(s)) d(s)^-(n+2) ds   (length of the vector)
/// over all p whose distance from the piece, the segment q from -1 to 1, is at least that of a row.
///
/// Derivation. |x|^-n is harmonic in n + 2 dimensions. Taken as functions there, the same along all directions across
/// the piece, an integral and its rule differ by a harmonic function, the vectors by its gradient, and both vanish far
/// away. So their largest length on and beyond a border around the piece is that on the border: on lines beside the
/// piece and half circles about its ends, one variable. There they are smooth over the distance itself, and change sign
/// some m times; rows take the largest of places that are many times closer, and 1.1 times of it.
class RuleErrors {
 public:
  static constexpr int most_nodes = 16;
  struct Error {
    double field = 0, gradient = 0;
  };
  /// What rows are for: w = 1; any w = ((1 + k s) / (1 + |k|))^(n-1), ^n in the vector, with |k| <= 1; these times any
  /// (1 + l s) / (1 + |l|) with |l| <= 1.
  enum class Weight { Constant, Tapered, Leaning };
  using Row = std::array<Error, most_nodes + 1>;  ///< by the number of nodes; [0] is not used

  /// Of one degree n; made at its first use, row by row as they are asked for.
  static const RuleErrors& of(int degree);

  /// Where there are rows, in half lengths of the piece.
  static constexpr double least_distance = 0.25, end_of_distances = 16;
  /// The row of the largest distance that is not above this one; in the range above.
  const Row& row(double distance, Weight) const;

 private:
  static constexpr int least_exponent = -1;      // frexp() of least_distance
  static constexpr int octaves = 6, steps = 32;  // of distances; a step apart errors differ by up to two times
  explicit RuleErrors(int degree) : degree_(degree) {}

  int degree_;
  std::array<std::array<Lazy<Row>, octaves * steps>, 3> rows_;  // by the weight
};

}  // namespace marrow
