// From where on a strand has no direction.
#pragma once

namespace marrow {

/// A strand whose sum f_s u_s is shorter than this times its f has no direction: where it runs back along itself what
/// is left of that sum is rounding, which in sums of floats is some 1e-6 of f.
inline constexpr double least_direction = 1e-5;

}  // namespace marrow
