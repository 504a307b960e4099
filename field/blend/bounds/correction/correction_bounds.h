// Bounds of the correction operator and its partial derivatives over intervals of f and G.
#pragma once

#include "field/blend/blend_field.h"
#include "field/number/interval.h"

namespace marrow {

/// C over all f and G of the intervals.
Interval correction_bounds(const Correction&, const Interval& f, const Interval& G);
/// C over these and over all angles between those of two corrections that differ in nothing else.
Interval correction_bounds_between(const BoundedCorrection& least, const BoundedCorrection& most, const Interval& f,
                                   const Interval& G);

struct PartialBounds {
  Interval df, dG;
  Interval dalpha = Interval::everything();
};
inline PartialBounds hull(const PartialBounds& a, const PartialBounds& b) {
  return {hull(a.df, b.df), hull(a.dG, b.dG), hull(a.dalpha, b.dalpha)};
}
/// dC/df, dC/dG and dC/dalpha there, for all angles of `alpha`, whose least is that of the correction; `value` is what
/// correction_bounds() gave. Everything where no bound is known.
PartialBounds partial_bounds(const BlendField&, const Correction&, const Interval& alpha, const Interval& value,
                             const Interval& f, const Interval& G);

}  // namespace marrow
