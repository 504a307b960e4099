// What a correction operator gives at (f, G): its value and how it changes.
#pragma once

namespace marrow {

struct CorrectionPartials {
  double value = 0;
  double df = 0;
  double dG = 0;  ///< may be infinite at G = 0 without cavity
  /// dC/dG / G, so that d(corrected) = df * grad f + dG_over_G * J^T grad_S f. Finite at G = 0 with cavity
  /// (there the corrected field is smooth); without, 0 is given at G = 0, where no derivative exists.
  double dG_over_G = 0;
  double dalpha = 0;  ///< 0 where C = f
};

/// The same of an operator without its cavity branch, where C is smooth in f and G.
struct ProjectedSlopes {
  double value, df, dG, dalpha;

  CorrectionPartials partials_at(double G) const {
    constexpr double smallest_gradient = 1e-150;  // below this G has no direction to speak of
    return {.value = value, .df = df, .dG = dG, .dG_over_G = G > smallest_gradient ? dG / G : 0, .dalpha = dalpha};
  }
};

}  // namespace marrow
