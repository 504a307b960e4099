// Guards the machine that runs the tests.
#pragma once

#include <stdexcept>

#include "field/blend/blend_field.h"
#include "field/trace/curve/iso_curve.h"

namespace marrow::test {

/// If space far away were not dropped, the cells of a blend would take all memory.
inline void expect_far_space_is_dropped(const BlendField& field, const IsoCurve& iso) {
  if (field.size() > 0 && !iso.outside(0, 0.01, 0.01)) throw std::runtime_error("tiny fields are not outside");
}
inline void expect_far_space_is_dropped(const BlendField& field) {
  expect_far_space_is_dropped(field, IsoCurve(correction_of(field), field.alpha));
}

}  // namespace marrow::test
