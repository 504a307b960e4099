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

}  // namespace marrow
