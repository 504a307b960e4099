// A projection angle from the value of a field.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "field/blend/angle/alpha_sample.h"
#include "field/number/places_in.h"
#include "field/number/variables_at.h"
#include "field/program/field_program.h"
#include "field/skeleton/second_order.h"

namespace marrow {

class RampedField : public AlphaSource {
 public:
  /// The program is in the coordinates of the blend that it steers.
  RampedField(FieldProgram program, const AlphaRamp& ramp) : program_(std::move(program)), ramp_(ramp) {
    trees_.assign(program_.trees().begin(), program_.trees().end());
    for (const PlacedBlend& part : program_.parts()) trees_.push_back(tree_of(part));
  }

  AlphaSample at(const Vec3d& p) const override {
    const FieldSample s = evaluate(program_, p);
    const double slope = is_level_at(s.value) ? 0 : slope_of_ramp();
    return {.value = ramp_(s.value), .gradient = slope == 0 ? Vec3d{} : s.gradient * slope};
  }

  HessianJet second_order_at(const Vec3d& p) const override {
    const HessianJet v = second_order_value(program_, variables_at<HessianJet>(p));
    if (is_level_at(v.value)) return ramp_(v.value);
    return ramp_.to[0] + (v - ramp_.from[0]) * slope_of_ramp();
  }

  // A ramp is monotone.
  Interval bounds(const Box3& box) const override {
    const Interval v = enclosed<Interval>(places_in(box));
    const double a = ramp_(v.lo), b = ramp_(v.hi);
    return {rounding::down(std::min(a, b), 8), rounding::up(std::max(a, b), 8)};
  }

  Vec3<Interval> slopes(const Box3& box) const override {
    using X = Jet<Interval, 3>;
    const X v = enclosed<X>(variables_at<X>(places_in(box)));
    const auto [least, most] = ramp_.from;
    if (v.value.hi < least || v.value.lo > most) return {Interval(0), Interval(0), Interval(0)};
    const bool level_too = v.value.lo <= least || v.value.hi >= most;
    const Interval slope = level_too ? hull(Interval(0), slope_of_ramp()) : Interval(slope_of_ramp());
    return {v.slope[0] * slope, v.slope[1] * slope, v.slope[2] * slope};
  }

 private:
  bool is_level_at(double value) const { return !(value > ramp_.from[0] && value < ramp_.from[1]); }
  double slope_of_ramp() const { return (ramp_.to[1] - ramp_.to[0]) / (ramp_.from[1] - ramp_.from[0]); }
  template <Number X>
  X enclosed(const Vec3<X>& p) const {
    X most = value(trees_.front(), p);
    for (std::size_t i = 1; i < trees_.size(); ++i) most = max(most, value(trees_[i], p));
    return most;
  }

  FieldProgram program_;
  std::vector<FieldTree> trees_;  ///< all of it; never empty
  AlphaRamp ramp_;
};

}  // namespace marrow
