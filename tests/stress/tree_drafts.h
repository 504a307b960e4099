// What scenes of general trees are drawn from.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "field/math/affine.h"
#include "field/tree/field_tree.h"
#include "tests/field/random.h"

namespace marrow::test {

inline constexpr std::array tree_kind_names{"any nodes", "creases", "warps",        "threads",
                                            "supports",  "kernels", "convolutions", "crowd"};

inline constexpr std::size_t kernels_kind = 5;

/// A tree, and where it is hardest; within some units of the origin before it is placed by `place`.
struct TreeDraft {
  FieldTree tree;
  std::vector<Vec3d> places;  ///< corners, tangent points, tips, axes: of the placed tree
  double focus_size = 0.1;    ///< about how far around them it is hard, before it is placed
};

TreeDraft draft_tree(std::size_t kind, const Affine& place, Random&);

}  // namespace marrow::test
