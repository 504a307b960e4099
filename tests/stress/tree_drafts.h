// What scenes of general trees are drawn from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "field/math/affine.h"
#include "field/tree/field_tree.h"
#include "tests/field/random.h"

namespace marrow::test {

inline constexpr std::array tree_kind_names{"any nodes",    "creases", "warps",      "threads", "supports", "kernels",
                                            "convolutions", "crowd",   "coincident", "cusps",   "squeezed", "pressed",
                                            "powers",       "sheets",  "odd blends", "planes",  "shells",   "joined",
                                            "hundreds",     "cuts",    "joins"};
/// Of them, those after the first so many are odd, as nobody would model them, in scenes from this number on; the last
/// three, of blends of hundreds of skeletons, of set operations on such blends, and of what changes them only in
/// places, have scenes of their own, too.
inline constexpr std::size_t usual_tree_kinds = 8, odd_tree_kinds = tree_kind_names.size() - usual_tree_kinds - 3;
inline constexpr std::uint64_t first_odd_tree = 2'000'000'000, first_tree_of_hundreds = 3'000'000'000,
                               first_tree_of_cuts = 4'000'000'000, first_tree_of_joins = 5'000'000'000;

inline constexpr std::size_t kernels_kind = 5, cusps_kind = 9, hundreds_kind = tree_kind_names.size() - 3,
                             cuts_kind = tree_kind_names.size() - 2, joins_kind = tree_kind_names.size() - 1;

/// Whether blends in it are traced by themselves where that is possible.
inline bool has_traced_blends(std::size_t kind) { return kind == cuts_kind || kind == joins_kind; }

inline std::size_t tree_kind_of(std::uint64_t scene) {
  if (scene >= first_tree_of_joins) return joins_kind;
  if (scene >= first_tree_of_cuts) return cuts_kind;
  if (scene >= first_tree_of_hundreds) return hundreds_kind;
  return scene < first_odd_tree ? scene % usual_tree_kinds : usual_tree_kinds + scene % odd_tree_kinds;
}

/// Of blends that are traced by themselves: the size of hard places over the radius of strands.
inline constexpr double focus_over_radius = 4;

/// A tree, and where it is hardest; within some units of the origin before it is placed by `place`.
struct TreeDraft {
  FieldTree tree;
  std::vector<Vec3d> places;  ///< corners, tangent points, tips, axes: of the placed tree
  double focus_size = 0.1;    ///< about how far around them it is hard, before it is placed
};

TreeDraft draft_tree(std::size_t kind, const Affine& place, Random&);

}  // namespace marrow::test
