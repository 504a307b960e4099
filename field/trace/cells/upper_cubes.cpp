#include "field/trace/cells/upper_cubes.h"

#include <memory>

#include "field/trace/cells/divider.h"

namespace marrow {
namespace {

// Each level folds sources whose errors come close to their budgets, and they count in all cubes below. With this share
// of the budgets the levels together cause less than a tile does. Figures in the README.
constexpr double share_of_budget = 1.0 / 8;

NearFar closer(const NearFar& fine, const BlockKernels& kernels) {
  const ErrorBudget budget{.field = share_of_budget * fine.budget().field,
                           .gradient = share_of_budget * fine.budget().gradient};
  return {fine.degree(), budget, kernels, fine.far_degree()};
}

}  // namespace

UpperCubes::UpperCubes(const SourceTree& sources, const NearFar& coarse, const NearFar& fine,
                       const BlockKernels& kernels)
    : sources_(sources), coarse_(coarse), fine_(closer(fine, kernels)) {}

const UpperCube& UpperCubes::add(const Vec3d& center, double half, const UpperCube* parent, int octant) {
  return cubes_.emplace_back(center, half, parent, octant);
}

const KeptSurroundings& UpperCubes::around(const UpperCube& cube, Seen seen, const NearFar& precision,
                                           double largest_group) const {
  return (cube.*seen).get([&] {
    const auto* const parent = cube.parent != nullptr ? &around(*cube.parent, seen, precision, largest_group) : nullptr;
    return std::make_unique<const KeptSurroundings>(
        refined(precision, sources_, parent, cube.octant, cube.center, cube.half, largest_group));
  });
}

const KeptSurroundings& UpperCubes::coarse_around(const UpperCube& cube) const {
  return around(cube, &UpperCube::coarse, coarse_, largest_coarse_group);
}

const KeptSurroundings& UpperCubes::fine_around(const UpperCube& cube) const {
  return around(cube, &UpperCube::fine, fine_, largest_fine_group);
}

std::size_t UpperCubes::bytes() const {
  std::size_t sum = cubes_.size() * sizeof(UpperCube);
  for (const UpperCube& cube : cubes_)
    for (const auto* lazy : {&cube.coarse, &cube.fine})
      if (const KeptSurroundings* s = lazy->peek()) sum += sizeof *s + s->bytes();
  return sum;
}

}  // namespace marrow
