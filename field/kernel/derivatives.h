// How far a field is differentiated.
#pragma once

namespace marrow {

/// How much of a sample is computed; the rest stays 0. What is computed is computed by the same operations at
/// every level, so that levels agree bit for bit.
enum class Derivatives {
  ScaleInvariant,  ///< value and scale-invariant gradient: what the corrected value needs
  First,           ///< and the gradient
  Second           ///< and the Jacobian of the scale-invariant gradient: for the gradient of the corrected field
};

}  // namespace marrow
