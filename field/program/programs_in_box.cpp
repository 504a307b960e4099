#include "field/program/programs_in_box.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "field/number/places_in.h"
#include "field/tree/tree_node.h"

namespace marrow {

ProgramsInBox::ProgramsInBox(std::span<const FieldProgram* const> programs) {
  for (const FieldProgram* program : programs) {
    for (const PlacedBlend& part : program->parts()) trees_.push_back(tree_referring_to(part));
    trees_.insert(trees_.end(), program->trees().begin(), program->trees().end());
  }
}

ProgramsInBox ProgramsInBox::within(const Box3& box) const {
  struct Candidate {
    FieldTree tree;
    Interval value;
  };
  std::vector<Candidate> candidates;
  double least = -std::numeric_limits<double>::infinity();  // what is below is never the largest
  for (const FieldTree& tree : trees_) {
    FieldTree here = localized(tree, box);
    const Interval v = value(here, places_in(box));
    least = std::max(least, v.lo);
    candidates.push_back({std::move(here), v});
  }
  ProgramsInBox made;
  for (Candidate& c : candidates)
    if (c.value.hi >= least) made.trees_.push_back(std::move(c.tree));
  return made;
}

FieldSample ProgramsInBox::at(const Vec3d& p) const {
  if (trees_.empty()) return {};
  const FieldTree* largest = &trees_.front();
  double most = trees_.size() > 1 ? value(*largest, p) : 0;
  for (std::size_t i = 1; i < trees_.size(); ++i) {
    const double v = value(trees_[i], p);
    if (v > most) largest = &trees_[i];
    most = std::max(most, v);
  }
  return value_and_gradient(*largest, p);
}

std::size_t count_of_all(const FieldProgram& program) {
  std::size_t count = 0;
  for (const PlacedBlend& part : program.parts()) count += part.blend.size();
  for (const FieldTree& tree : program.trees())
    for (const FieldTree::Record& record : tree.records()) {
      const auto* blend = std::get_if<BlendLeaf>(&tree.node(record));
      count += blend != nullptr ? blend->field->size() : 1;
    }
  return count;
}

}  // namespace marrow
