// A far field as cubes keep it for those below them: a quarter to a half of the memory that sums need.
#pragma once

#include <cstddef>
#include <vector>

#include "field/trace/sources/far_field.h"

namespace marrow {

/// Coefficients as floats, and none of higher degrees than there are. What rounding them changes over the cube, at
/// most, counts in the errors.
class KeptFarField {
 public:
  KeptFarField() = default;
  explicit KeptFarField(const FarField&);

  FarField whole() const;
  /// Without the object itself.
  std::size_t bytes() const { return coefficients_.capacity() * sizeof(float); }

 private:
  int degree_ = 0;
  double f_error_ = 0, gradient_error_ = 0;  // FarField's
  std::vector<float> coefficients_;          // of the field, then of the potential
};

}  // namespace marrow
