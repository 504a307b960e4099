// The projection angle of blends whose skeletons have one each, or one that is linear along them, as a second field of
// the kind that is traced.
//
// alpha(p) = sum f_i alpha_i / sum f_i [Zanni et al. 2015, eq. 14]. With the share a_i = (alpha_i - least) / (most -
// least) in [0, 1] of the range of all angles, the share at p is A / f with A = sum a_i f_i: the field of the same
// skeletons whose sources count a_i times, a_i being linear along the skeleton. All that is known of sums is known of
// A.
#pragma once

#include <optional>
#include <vector>

#include "field/trace/sources/pieces.h"

namespace marrow {

struct BlendField;

struct AngleRange {
  double least = 0, most = 0;  ///< radians
};

/// Of a blend whose skeletons have angles, or whose strands' directions give one; nothing where one angle holds
/// everywhere (single_angle()).
std::optional<AngleRange> angle_range(const BlendField&);

/// The pieces of A, in their order; without those of skeletons with the least angle, whose share is 0.
std::vector<Piece> angle_pieces(const BlendField&, const AngleRange&, const std::vector<Piece>&);

}  // namespace marrow
