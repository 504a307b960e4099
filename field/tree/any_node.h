// The table of all kinds of nodes. A new kind is its own file and one row here.
#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "field/tree/nodes/bend.h"
#include "field/tree/nodes/box.h"
#include "field/tree/nodes/cone.h"
#include "field/tree/nodes/contact.h"
#include "field/tree/nodes/convolution_segment.h"
#include "field/tree/nodes/crisp.h"
#include "field/tree/nodes/cylinder.h"
#include "field/tree/nodes/disc.h"
#include "field/tree/nodes/ellipsoid.h"
#include "field/tree/nodes/line.h"
#include "field/tree/nodes/local_convolution.h"
#include "field/tree/nodes/plane.h"
#include "field/tree/nodes/polygon.h"
#include "field/tree/nodes/restricted_blend.h"
#include "field/tree/nodes/ricci.h"
#include "field/tree/nodes/sharp_csg.h"
#include "field/tree/nodes/shear.h"
#include "field/tree/nodes/soft_csg.h"
#include "field/tree/nodes/sphere.h"
#include "field/tree/nodes/sum.h"
#include "field/tree/nodes/taper.h"
#include "field/tree/nodes/torus.h"
#include "field/tree/nodes/twist.h"
#include "field/tree/nodes/weighted_blend.h"

namespace marrow {

/// Documentation lists them in this order.
using AnyNode = std::variant<                        //
    Sphere, Ellipsoid, Cylinder, Cone, Box, Torus,   // solids with a bounded field
    Plane, Disc, LineSolid, Polygon,                 //
    ConvolutionSegment, LocalConvolution,            // integrals of older papers
    Intersection, Difference,                        // set operations
    SoftUnion, SoftIntersection, SoftDifference,     //
    SharpUnion, SharpIntersection, SharpDifference,  //
    Sum, Ricci, WeightedBlend, RestrictedBlend,      // blends
    Contact,                                         //
    Twist, Taper, Bend, Shear>;                      // warps

struct BoxedNode {
  AnyNode node;
};
inline std::shared_ptr<const BoxedNode> boxed(AnyNode node) {
  return std::make_shared<const BoxedNode>(BoxedNode{std::move(node)});
}

inline const NodeInfo& info_of(const AnyNode& node) {
  return std::visit([]<class Kind>(const Kind&) -> const NodeInfo& { return Kind::info; }, node);
}

}  // namespace marrow
