// How large |grad_S f| may be where the surface of a blend is.
#pragma once

namespace marrow {

struct BlendField;

/// Of segments of the integral model under the inverse kernel; points have less. The shorter a segment is against its
/// radius, the nearer to it is the surface. A bound for even radii, for others an estimate.
double largest_gradient(const BlendField&);

}  // namespace marrow
