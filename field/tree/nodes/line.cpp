#include "field/tree/nodes/line.h"

namespace marrow {

Box3 LineSolid::support() const {
  Box3 solid = Box3{from, from}.padded(radius.front());
  solid.include(Box3{to, to}.padded(radius.back()));
  return reached(solid, range_of(potential));
}

}  // namespace marrow
