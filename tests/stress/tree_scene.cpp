// Scenes of general trees that are hard to trace.
#include "tests/stress/tree_scene.h"

#include <stdexcept>
#include <utility>

#include "renderer/geometry/tree_solid.h"
#include "tests/geometry/boolean_scene.h"
#include "tests/trace/large_cells.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

struct Placement {
  Affine map;
  double scale = 1;
};

Placement random_placement_of_scene(Random& random) {
  if (random.between(0, 1) < 0.5) return {};
  Placement p;
  if (random.between(0, 1) < 0.7) p.scale = pow(10, random.between(-4, 4));
  const double away = random.between(0, 1) < 0.5 ? 0 : pow(10, random.between(0, 5));
  const Affine turn =
      random.between(0, 1) < 0.5 ? Affine{} : Affine::rotate(normalize(random.vector(1)), random.between(-3, 3));
  p.map = Affine::translate(random.vector(away * p.scale)) * turn * Affine::scale(Vec3d{1, 1, 1} * p.scale);
  return p;
}

// Blends under set operations as a scene has them, all else by the general tracer.
std::unique_ptr<Solid> solid_of(const FieldTree& tree, std::size_t kind, std::shared_ptr<const RaySpacing> spacing) {
  constexpr std::size_t few = 50;
  if (has_traced_blends(kind))
    if (auto solid = boolean_solid_of(tree, few, MaterialId{}, {}, spacing)) return solid;
  auto solid = TreeSolid::make(tree, MaterialId{}, TreeTracer::everywhere, {.lent = nullptr, .spacing = spacing});
  if (!solid) return nullptr;
  return std::move(*solid);
}

}  // namespace

TreeScene::TreeScene(std::uint64_t number) : kind_(tree_kind_of(number)) {
  Random random(number, Random::Silent{});
  const Placement placement = random_placement_of_scene(random);
  TreeDraft draft = draft_tree(kind_, placement.map, random);
  name_ = "tree " + std::to_string(number) + " (" + tree_kind_names[kind_] + ", scale " +
          std::to_string(placement.scale) + ")";
  tree_ = std::move(draft.tree);
  places_ = std::move(draft.places);
  focus_size_ = draft.focus_size * placement.scale;
  std::unique_ptr<Solid> solid = solid_of(tree_, kind_, random.between(0, 1) < 0.5 ? nullptr : hardly_a_ray());
  if (solid == nullptr) throw std::runtime_error(name_ + " cannot be traced");
  for (std::size_t i = 0; i < solid->element_count(); ++i) cells_.include(solid->element_box(i));
  // A tree without surface: rays go where it might be.
  if (cells_.empty()) cells_ = Box3{placement.map.translation, placement.map.translation}.padded(placement.scale);
  center_ = cells_.center();
  size_ = 0.5 * length(cells_.size());
  std::vector<PlacedSolid> solids;
  solids.push_back({std::move(solid), ObjectId{0}});
  auto made = EmbreeSurfaces::make(std::move(solids), {}, "threads=1");
  if (!made) throw std::runtime_error(name_ + " has no surfaces");
  surfaces_ = std::move(*made);
}

Box3 TreeScene::random_cell(Random& random) const {
  const Solid& all = *surfaces_->solids()[0].solid;
  if (all.element_count() == 0) return cells_;
  return all.element_box(static_cast<std::size_t>(random.whole(0, static_cast<int>(all.element_count()) - 1)));
}

Vec3d TreeScene::random_focus(Random& random) const {
  if (places_.empty()) return random_in(random, random_cell(random));
  return places_[static_cast<std::size_t>(random.whole(0, static_cast<int>(places_.size()) - 1))];
}

}  // namespace marrow::test
