// Bisects for the angle of contact.
#include "field/blend/contact.h"

#include <numbers>

#include "field/blend/correction.h"

namespace marrow {

double contact_alpha(int degree, bool cavity, Projection projection) {
  double below = 0, above = std::numbers::pi / 2;  // C(2, 0) rises with alpha from less than 1 to 2
  for (;;) {
    const double middle = below + (above - below) / 2;
    if (!(below < middle && middle < above)) return above;
    (Correction(degree, middle, cavity, projection).value(2, 0) < 1 ? below : above) = middle;
  }
}

}  // namespace marrow
