#include "field/tree/nodes/cone.h"

namespace marrow {

std::string Cone::problem(std::size_t) const {
  if (radius.size() > 2) return "radius must be one number or two";
  if (radius.front() == 0 && radius.back() == 0) return "one of the radii must be above 0";
  return from == to ? "from and to must differ" : "";
}

Box3 Cone::support() const {
  const UnitVec3 axis = normalize(to - from);
  Box3 solid = disc_box(from, axis, radius.front());
  solid.include(disc_box(to, axis, radius.back()));
  return reached(solid, range_of(potential));
}

}  // namespace marrow
