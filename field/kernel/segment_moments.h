// The weighted moments of a segment of linear radius from which its field and all its derivatives are made.
#pragma once

#include "field/kernel/derivatives.h"

namespace marrow {

/// A segment as seen from a point: t runs along it from the foot of the point, t1 < t2 at its ends,
/// the point stands at height h over its line, and tau(t) = radius_at_foot + slope t is the radius.
struct SegmentView {
  double t1, t2;
  double h_squared;
  double slope;
  double radius1;         ///< at t1, > 0
  double radius_at_foot;  ///< may be <= 0 when the foot is outside

  double length() const { return t2 - t1; }
};

/// M(e, m, j) = int tau^e t^j d^-m dt with d^2 = t^2 + h^2, for a kernel of degree m and a skeleton of dimension D
/// (1: the segment itself, 2: a surface of which it is a line), e = m - D:
///   value M(e, m, 0);  first[j] M(e, m+2, j);  si[j] M(e+1, m+2, j);  second[j] M(e+1, m+4, j).
struct SegmentMoments {
  double value = 0;
  double first[2] = {0, 0};
  double si[2] = {0, 0};
  double second[3] = {0, 0, 0};
};

/// Relative error below 1e-13 in each sum these moments enter. Where the segment is short against its distance,
/// one Gauss-Legendre rule; where the foot lies inside, closed forms; else Gauss-Legendre panels that grow with
/// their distance from the point.   Precondition: distance to the segment > 0.
template <Derivatives>
SegmentMoments segment_moments(const SegmentView&, int degree, int dimension = 1);

/// The same by either method alone, wherever the point lies. For tests of one against the other.
template <Derivatives>
SegmentMoments segment_moments_by_panels(const SegmentView&, int degree, int dimension = 1);
template <Derivatives>
SegmentMoments segment_moments_by_recurrence(const SegmentView&, int degree, int dimension = 1);

}  // namespace marrow
