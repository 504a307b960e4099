#include "field/trace/upper_cubes.h"

#include <memory>

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

Surroundings refined(const NearFar& precision, const SourceTree& sources, const Surroundings* parent, int octant,
                     const Vec3d& center, double half, double keep) {
  Surroundings s;
  if (parent != nullptr) s.far = parent->far.of_child(octant);
  s.near = precision.split(sources, parent != nullptr ? parent->near : sources.roots(), center, half, keep, s.far);
  return s;
}

UpperCubes::UpperCubes(const SourceTree& sources, const NearFar& coarse, const NearFar& fine,
                       const BlockKernels& kernels)
    : sources_(sources), coarse_(coarse), fine_(closer(fine, kernels)) {}

const UpperCube& UpperCubes::add(const CubeView& view, const UpperCube* parent, int octant) {
  return cubes_.emplace_back(view.center, view.half, parent, octant);
}

const Surroundings& UpperCubes::coarse_around(const UpperCube& cube) const {
  return cube.coarse.get([&] {
    const auto* const parent = cube.parent != nullptr ? &coarse_around(*cube.parent) : nullptr;
    return std::make_unique<const Surroundings>(
        refined(coarse_, sources_, parent, cube.octant, cube.center, cube.half, largest_coarse_group));
  });
}

const Surroundings& UpperCubes::fine_around(const UpperCube& cube) const {
  return cube.fine.get([&] {
    const auto* const parent = cube.parent != nullptr ? &fine_around(*cube.parent) : nullptr;
    return std::make_unique<const Surroundings>(
        refined(fine_, sources_, parent, cube.octant, cube.center, cube.half, largest_fine_group));
  });
}

std::size_t UpperCubes::bytes() const {
  std::size_t sum = cubes_.size() * sizeof(UpperCube);
  for (const UpperCube& cube : cubes_)
    for (const auto* lazy : {&cube.coarse, &cube.fine})
      if (const Surroundings* s = lazy->peek()) sum += s->bytes();
  return sum;
}

}  // namespace marrow
