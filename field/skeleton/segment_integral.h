// The integral along a segment under any kernel, as a sum of points; internal to skeleton/.
#pragma once

#include "field/skeleton/line_integral.h"
#include "field/skeleton/seen_line.h"

namespace marrow {

/// A point in the place of a piece of a segment.
struct SegmentNode {
  Vec3d v;        ///< from the node to the point that is asked
  double tau;     ///< the radius there
  double weight;  ///< of the kernel, normalised
  double share;   ///< of the segment's length, from its start
};

/// Calls visit(node) such that sums of weight k(|v| / tau) times a polynomial of low degree in the share are integrals
/// along the segment, as integrate_line() says. `seen`: the segment from the point; the profile is that of the kernel
/// for curves.
template <class Visit>
void integrate_segment(const SegmentSkeleton& segment, const SeenLine& seen, const Kernel& kernel,
                       const Profile& profile, const Visit& visit) {
  const auto& [length, foot, u, across, line] = seen;
  integrate_line(line, kernel, 1, [&](double t, double weight) {
    const double from_start = t + foot, tau = segment.radius_from + line.slope * from_start;
    visit(SegmentNode{across - u * t, tau, weight / (profile.normalisation() * tau), from_start / length});
  });
}

}  // namespace marrow
