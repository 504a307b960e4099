// The projection angle from the directions of strands: parallel hairs blend, crossing ones stay apart.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "field/blend/angle/alpha_sample.h"
#include "field/math/matrix3.h"
#include "field/math/vec3.h"
#include "field/number/functions.h"

namespace marrow {

/// Angle of crossing strands (`least`, radians) and of parallel ones (`most`).
struct DirectionBounds {
  double least = 0, most = 0;
  friend bool operator==(const DirectionBounds&, const DirectionBounds&) = default;
};

/// One strand at a point: a segment by itself, or all segments of a polyline, curve or skeleton.
struct Strand {
  double field = 0;      ///< f_i, the sum of its segments
  Vec3d field_gradient;  ///< used for the gradient alone
  Vec3d direction;       ///< sum f_s u_s over its segments; shorter than least_direction field: none
  Matrix3 direction_jacobian;
  DirectionBounds bounds;
};

/// alpha = sum_{i != j} f_i f_j gamma_ij / sum_{i != j} f_i f_j,   gamma_ij = A_ij (u_i . u_j)^8 + B_ij, with
/// B the least angle and A what the most one adds, each the mean of the two strands', and u_i the direction of length 1
/// (a strand without one crosses all others).   [Zanni et al. 2015, eq. 15 and 16]
/// Where the denominator is 0 (one strand, or the others too far): the mean of `most`, weighted by f_i, without
/// gradient; there C hardly depends on alpha. Nothing for no field at all.
/// Up to 64 strands are taken pair by pair, more in a time linear in their number: (u . v)^8 is a product of symmetric
/// tensors with 45 components; sums run over the strands before, so that nothing cancels (error 1e-15).
AlphaSample directional_alpha(std::span<const Strand>, bool with_gradient);

/// The same strands over numbers with second derivatives.
struct SecondOrderStrand {
  HessianJet field;
  Vec3<HessianJet> direction;  ///< as of a Strand
  DirectionBounds bounds;
};
HessianJet directional_alpha(std::span<const SecondOrderStrand>);

}  // namespace marrow
