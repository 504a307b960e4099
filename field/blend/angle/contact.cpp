// Bisects for the angle of contact.
#include "field/blend/angle/contact.h"

#include <numbers>

#include "field/blend/correction/correction.h"

namespace marrow {

namespace {

// The least angle from `alpha` on at which a lone skeleton of a bounded kernel is solid; pi/2 always is one.
double solid_alpha(const Kernel& kernel, double alpha, bool cavity, Projection projection) {
  const auto is_solid = [&](double a) { return Correction(kernel, a, cavity, projection).bounded()->solid_alone(); };
  double below = alpha, above = std::numbers::pi / 2;
  if (is_solid(below)) return below;
  for (int i = 0; i < 40; ++i) {
    const double middle = below + (above - below) / 2;
    (is_solid(middle) ? above : below) = middle;
  }
  return above;
}

}  // namespace

double contact_alpha(const Kernel& kernel, bool cavity, Projection projection) {
  if (cavity && !contact_is_exact(kernel, cavity, projection))
    return solid_alpha(kernel, contact_alpha(kernel, false, projection), cavity, projection);
  double below = 0, above = std::numbers::pi / 2;  // C(2, 0) rises with alpha from less than 1 to 2
  for (;;) {
    const double middle = below + (above - below) / 2;
    if (!(below < middle && middle < above)) return above;
    (Correction(kernel, middle, cavity, projection).value(2, 0) < 1 ? below : above) = middle;
  }
}

double contact_alpha(int degree, bool cavity, Projection projection) {
  return contact_alpha(Kernel{.degree = degree}, cavity, projection);
}

bool contact_is_exact(const Kernel& kernel, bool cavity, Projection projection) {
  // at alpha = 0, C is at most the top of the curve, which may be 1 but for rounding
  constexpr double rounding = 1e-9;
  return Correction(kernel, 0, cavity, projection).value(2, 0) < 1 - rounding;
}

}  // namespace marrow
