// How much less of its Taylor series a far source leaves in a cube than in the ball about it.
#pragma once

namespace marrow {

/// The series of |x - r|^-m about the centre of a cube has the terms C_k^(m/2)(cos) |x|^k |r|^-(m+k), cos that of the
/// angle between x and r. taylor_remainder() takes them at cos = 1 and |x| = sqrt(3), where the Gegenbauer polynomials
/// are largest and the ball ends. A cube has such an x only where the source lies towards a corner; towards a face
/// |x| = 1 is what cos = 1 leaves, and corners see the source from the side.
///
/// `share[i]` bounds what is left of taylor_remainder(), and of that of the gradient, for directions u of the source
/// with |u_x| + |u_y| + |u_z| <= remainder_spread[i]; beyond the last one it is 1. Found numerically, not proved: the
/// largest sum of the terms' absolute values over that, and 3 % more, of a grid (120 directions, 33 x 33 places on each
/// face, m = 2..21) and of 1.5 million random ones, on faces, edges and corners, for balls that reach a hundredth to a
/// half of the way to the source. tests/trace/cube_remainder_test.cpp asks others.
template <int FarDegree>
struct CubeRemainder;

inline constexpr int remainder_steps = 8;
inline constexpr float remainder_spread[remainder_steps] = {1.3F, 1.36F, 1.48F, 1.54F, 1.6F, 1.64F, 1.68F, 1.71F};

template <>
struct CubeRemainder<4> {
  static constexpr float share[remainder_steps] = {0.247F, 0.295F, 0.395F, 0.505F, 0.64F, 0.745F, 0.86F, 0.955F};
};

template <>
struct CubeRemainder<6> {
  static constexpr float share[remainder_steps] = {0.19F, 0.215F, 0.262F, 0.347F, 0.5F, 0.63F, 0.785F, 0.92F};
};

// Its own are smaller by up to a third, but where that lets sources count as far the polynomials gain nothing.
template <>
struct CubeRemainder<8> : CubeRemainder<6> {};

}  // namespace marrow
