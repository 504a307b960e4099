// Bisects for the angle of contact.
#include "field/blend/contact.h"

#include <numbers>

#include "field/blend/correction.h"

namespace marrow {

double contact_alpha(const Kernel& kernel, bool cavity, Projection projection) {
  if (cavity && !contact_is_exact(kernel, cavity, projection)) return contact_alpha(kernel, false, projection);
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
  return Correction(kernel, 0, cavity, projection).value(2, 0) < 1;
}

}  // namespace marrow
