// The table of all kinds of nodes. A new kind is its own file and one row here.
#pragma once

#include <variant>

#include "field/tree/nodes/box.h"
#include "field/tree/nodes/cone.h"
#include "field/tree/nodes/crisp.h"
#include "field/tree/nodes/cylinder.h"
#include "field/tree/nodes/disc.h"
#include "field/tree/nodes/ellipsoid.h"
#include "field/tree/nodes/line.h"
#include "field/tree/nodes/plane.h"
#include "field/tree/nodes/polygon.h"
#include "field/tree/nodes/ricci.h"
#include "field/tree/nodes/sphere.h"
#include "field/tree/nodes/torus.h"
#include "field/tree/nodes/twist.h"

namespace marrow {

/// Documentation lists them in this order.
using AnyNode = std::variant<  //
    Sphere, Ellipsoid,         // primitives
    Cylinder, Cone,            //
    Box, Torus,                //
    Plane, Disc,               //
    LineSolid, Polygon,        //
    Intersection, Difference,  // set operations
    Ricci,                     // blends
    Twist>;                    // warps

inline const NodeInfo& info_of(const AnyNode& node) {
  return std::visit([]<class Kind>(const Kind&) -> const NodeInfo& { return Kind::info; }, node);
}

}  // namespace marrow
