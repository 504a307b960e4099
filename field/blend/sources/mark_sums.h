// Sums of fields weighted by a number of each skeleton, from which means and variances over skeletons follow.
#pragma once

#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// sum v f and sum v^2 f of fields f with marks v, and their gradients.
struct MarkSums {
  double first = 0, second = 0;
  Vec3d first_gradient{}, second_gradient{};

  void add(const SkeletonSample& field, double mark) {
    const double square = mark * mark;
    first += field.value * mark;
    second += field.value * square;
    first_gradient += field.gradient * mark;
    second_gradient += field.gradient * square;
  }
  MarkSums& operator+=(const MarkSums& b) {
    first += b.first;
    second += b.second;
    first_gradient += b.first_gradient;
    second_gradient += b.second_gradient;
    return *this;
  }
};

}  // namespace marrow
