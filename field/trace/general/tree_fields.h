// The fields that the tracer of general trees asks at a place; internal to general/.
#pragma once

#include "field/trace/general/tree_cell.h"
#include "field/trace/general/tree_tracer.h"

namespace marrow {

// Of those that can be 1 at p, a point.
template <Number X>
X TreeTracer::largest_of_others(std::uint32_t member, const Vec3<X>& p) const {
  X largest(0.0);
  const Vec3d at{lower(p.x), lower(p.y), lower(p.z)};
  for (const UnionMember& other : members_)
    if (other.record != member && other.bounds.contains(at)) largest = max(largest, value(tree_, p, other.record));
  return largest;
}

// use(tree, record) of what is equal to the member at p.
template <class Use>
auto TreeTracer::with_field_near(const Cell& cell, const Vec3d& p, const Use& use) const {
  const bool is_near = cell.part != nullptr && cell.part->holds(p);
  return is_near ? use(cell.part->leaf_at(p).tree(), FieldTree::whole) : use(tree_, cell.member);
}

// The larger of the member's field and those of all others at a place, a box, or with derivatives.
template <Number X>
X TreeTracer::field_near(const Cell& c, const Vec3d& p, const Vec3<X>& there) const {
  const auto own = [&](const FieldTree& tree, std::uint32_t record) { return value(tree, there, record); };
  return max(with_field_near(c, p, own), largest_of_others(c.member, there));
}

}  // namespace marrow
