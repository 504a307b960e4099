#include "renderer/geometry/tree_solid.h"

namespace marrow {

Result<std::unique_ptr<TreeSolid>> TreeSolid::make(FieldTree tree, MaterialId of_object) {
  auto tracer = TreeTracer::make(std::move(tree));
  if (!tracer) return tracer.why();
  return std::unique_ptr<TreeSolid>(new TreeSolid(std::move(*tracer), of_object));
}

std::optional<double> TreeSolid::hit(std::size_t element, const Ray& ray, bool any, ElementLog& log) const {
  CellLog cell;
  const auto found = tracer_.first_hit(element, ray, any, cell);
  log.enter = cell.enter;
  log.undecided = cell.undecided;
  if (log.visits != nullptr && cell.evaluations > 0) log.visits->push_back({cell.enter, cell.evaluations});
  if (!found) return {};
  return found->t;
}

void TreeSolid::describe(std::span<const HitToDescribe> hits) const {
  for (const auto& [element, place, ray, hit] : hits) {
    const SurfacePoint surface = tracer_.surface_at(element, hit->position, ray->direction);
    hit->normal = surface.normal;
    hit->outside = surface.outside;
    const MaterialId own = tracer_.material_at(element, hit->position);
    hit->material = own.valid() ? own : material_;
  }
}

FieldSample TreeSolid::sample(const Vec3d& p) const {
  using X = Jet<double, 3>;
  const X f = marrow::value(tracer_.tree(), Vec3<X>{X::variable(p.x, 0), X::variable(p.y, 1), X::variable(p.z, 2)});
  return {.value = f.value, .gradient = {f.slope[0], f.slope[1], f.slope[2]}};
}

double TreeSolid::value(const Vec3d& p) const { return marrow::value(tracer_.tree(), p); }

std::size_t TreeSolid::primitive_count() const { return leaf_count(tracer_.tree()); }

}  // namespace marrow
