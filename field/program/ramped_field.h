// A projection angle from the value of a field.
#pragma once

#include <algorithm>
#include <utility>

#include "field/blend/alpha_sample.h"
#include "field/program/field_program.h"
#include "field/skeleton/second_order.h"

namespace marrow {

class RampedField : public AlphaSource {
 public:
  /// The program is in the coordinates of the blend that it steers.
  RampedField(FieldProgram program, const AlphaRamp& ramp) : program_(std::move(program)), ramp_(ramp) {}

  AlphaSample at(const Vec3d& p) const override {
    const FieldSample s = evaluate(program_, p);
    const double share = (s.value - ramp_.from[0]) / (ramp_.from[1] - ramp_.from[0]);
    const double slope = share > 0 && share < 1 ? (ramp_.to[1] - ramp_.to[0]) / (ramp_.from[1] - ramp_.from[0]) : 0;
    return {.value = ramp_(s.value), .gradient = slope == 0 ? Vec3d{} : s.gradient * slope};
  }

  HessianJet second_order_at(const Vec3d& p) const override {
    const HessianJet v = second_order_value(program_, variables_at(p));
    const double share = (v.value - ramp_.from[0]) / (ramp_.from[1] - ramp_.from[0]);
    if (!(share > 0 && share < 1)) return ramp_(v.value);
    return ramp_.to[0] + (v - ramp_.from[0]) * ((ramp_.to[1] - ramp_.to[0]) / (ramp_.from[1] - ramp_.from[0]));
  }

  // A ramp is monotone.
  Interval bounds(const Box3& box) const override {
    const Interval v = value_bounds(program_, box);
    const double a = ramp_(v.lo), b = ramp_(v.hi);
    return {rounding::down(std::min(a, b), 8), rounding::up(std::max(a, b), 8)};
  }

 private:
  FieldProgram program_;
  AlphaRamp ramp_;
};

}  // namespace marrow
