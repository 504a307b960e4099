// The field about a place, so that what is near by is known without a sum over sources.
#pragma once

namespace marrow {

/// In coordinates of a block.
struct PointField {
  float f, gradient[3];            ///< of f
  float si_gradient[3];            ///< G
  float hessian[6];                ///< of the potential: derivative of G; xx yy zz xy xz yz
  float nearest;                   ///< distance to the nearest source
  float second, third;             ///< M2 and m M3 of taylor_remainder.h, for bounds of f and G nearby
  float share, share_gradient[3];  ///< of the range of angles, where each skeleton has one; else 0
  float share_bend;                ///< |share - its linear part| <= share_bend h^2 on short steps h
};

/// The fine level of a block about a hit.
struct FieldAround {
  const void* block = nullptr;  ///< BlockView::owner; null: nothing is known, and the rest holds anything
  float place[3];               ///< of the hit
  PointField field;
};

}  // namespace marrow
