// The projection angles of the nodes of one skeleton.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "field/description/field_node.h"

namespace marrow {

/// Angles of a skeleton's nodes: of its points, of both ends of a segment or arc, of the corners of a triangle.
class NodeAngles {
 public:
  /// As the rule of the blend says (AlphaPerSkeleton, AlphaAttribute; else `otherwise` everywhere), and `otherwise` for
  /// skeletons that do not say it. A curve is subdivided as its points are.
  NodeAngles(const Primitive&, const Alpha& rule, double otherwise);

  double of(std::size_t node) const { return angles_.size() == 1 ? angles_.front() : angles_[node]; }

 private:
  std::vector<double> angles_;
};

/// Whether it has an attribute of this name, as all have `radius`.
bool has_attribute(const Primitive&, const std::string& name);

/// How many values an attribute of this skeleton may have besides one for all.
std::size_t node_count(const Primitive&);

}  // namespace marrow
