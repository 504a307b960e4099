// Bounds of the partial derivatives of the projection onto the curve of BoundedCurve; internal to blend/.
#pragma once

#include "field/blend/bounds/correction/correction_bounds.h"
#include "field/blend/bounds/correction/curve_bounds.h"
#include "field/blend/bounds/correction/projection_angles.h"

namespace marrow {

/// Of C without its cavity branch, for a range of angles in [0, pi/2].
class ProjectionPartials {
 public:
  ProjectionPartials(const CurveBounds&, Projection, const Angles&);
  /// `value` holds C over these intervals.
  PartialBounds at(const Interval& value, const Interval& f, const Interval& G) const;

 private:
  PartialBounds on_chord(const CurveBounds::Span& f, const Interval& G) const;
  PartialBounds on_line(const Interval& value, const Interval& f, const Interval& G) const;
  PartialBounds on_curve(const Interval& value, const Interval& f, const Interval& G) const;

  const CurveBounds& curve_;
  Projection projection_;
  Angles angle_;
};

}  // namespace marrow
