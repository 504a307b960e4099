// Bisects for the angle of contact.
#include "field/blend/angle/contact.h"

#include <numbers>

#include "field/blend/correction/correction.h"

namespace marrow {

namespace {

bool is_solid(const Kernel& kernel, double alpha, bool cavity, Projection projection) {
  const Correction correction(kernel, alpha, cavity, projection);
  return !correction.bounded() || correction.bounded()->solid_alone();
}

// The least angle from `alpha` on at which a lone skeleton is solid; pi/2 always is one.
double solid_alpha(const Kernel& kernel, double alpha, bool cavity, Projection projection) {
  double below = alpha, above = std::numbers::pi / 2;
  if (is_solid(kernel, below, cavity, projection)) return below;
  for (int i = 0; i < 40; ++i) {
    const double middle = below + (above - below) / 2;
    (is_solid(kernel, middle, cavity, projection) ? above : below) = middle;
  }
  return above;
}

// C(2, 0) rises with alpha from less than 1 to 2.
double joining_alpha(const Kernel& kernel, bool cavity, Projection projection) {
  double below = 0, above = std::numbers::pi / 2;
  for (;;) {
    const double middle = below + (above - below) / 2;
    if (!(below < middle && middle < above)) return above;
    (Correction(kernel, middle, cavity, projection).value(2, 0) < 1 ? below : above) = middle;
  }
}

}  // namespace

ContactAngle contact_angle(const Kernel& kernel, bool cavity, Projection projection) {
  // at alpha = 0, C is at most the top of the curve, which may be 1 but for rounding
  constexpr double rounding = 1e-9;
  const bool is_apart_at_0 = Correction(kernel, 0, cavity, projection).value(2, 0) < 1 - rounding;
  if (is_apart_at_0 || !cavity) {
    const double alpha = joining_alpha(kernel, cavity, projection);
    if (!cavity || is_solid(kernel, alpha, cavity, projection)) return {alpha, is_apart_at_0};
  }
  return {solid_alpha(kernel, joining_alpha(kernel, false, projection), cavity, projection), false};
}

double contact_alpha(const Kernel& kernel, bool cavity, Projection projection) {
  return contact_angle(kernel, cavity, projection).alpha;
}

double contact_alpha(int degree, bool cavity, Projection projection) {
  return contact_alpha(Kernel{.degree = degree}, cavity, projection);
}

}  // namespace marrow
