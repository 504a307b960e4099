#include "renderer/geometry/tree_solid.h"

#include <algorithm>
#include <cmath>

#include "field/blend/blend_field.h"
#include "field/math/growing_steps.h"
#include "field/number/places_in.h"
#include "field/tree/tree_node.h"

namespace marrow {
namespace {

bool holds_blends(const FieldTree& tree) {
  return std::ranges::any_of(
      tree.records(), [&](const FieldTree::Record& r) { return std::holds_alternative<BlendLeaf>(tree.node(r)); });
}

}  // namespace

Result<std::unique_ptr<TreeSolid>> TreeSolid::make(FieldTree tree, MaterialId of_object, const Box3& within,
                                                   TreeDivision division) {
  auto tracer = TreeTracer::make(std::move(tree), within, std::move(division));
  if (!tracer) return tracer.why();
  return std::unique_ptr<TreeSolid>(new TreeSolid(std::move(*tracer), of_object));
}

TreeSolid::TreeSolid(TreeTracer tracer, MaterialId of_object)
    : tracer_(std::move(tracer)), material_(of_object), holds_blends_(holds_blends(tracer_.tree())) {}

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

// A crossing that does not count is left behind by more than the gaps that its tracer cannot decide. A ray that runs in
// a face crosses it at every other place by rounding: the steps behind such crossings grow, and what they pass is told
// as undecided.
std::optional<double> TreeSolid::crossing(const SolidPart& part, const Ray& ray, const CrossingFilter& filter,
                                          ElementLog& log) const {
  const double size = max_component(element_box(part.element).size());
  const auto least_step = [&](double t) {
    const double away = std::fabs(t) + max_component(abs(ray.origin));
    return std::max(0x1p-33 * std::min(size, away), 0x1p-46 * away);
  };
  const double longest_step = 0x1p-8 * size, soon = 256;  // steps, from one crossing by rounding to the next
  Ray onward = ray;
  double step = 0;
  for (bool is_first = true;; is_first = false) {
    ElementLog here;
    here.visits = log.visits;
    const auto t = hit(part.element, onward, false, here);
    if (is_first) log.enter = here.enter;
    if (here.undecided < log.undecided && filter.counts_at(here.undecided)) log.undecided = here.undecided;
    if (!t || filter.counts_at(*t)) return t;
    const double least = least_step(*t);
    const bool in_face = !is_first && *t - onward.t_min < soon * step;
    step = in_face ? std::max(least, std::min(2 * step, longest_step)) : least;
    if (step > 16 * least) log.undecided = std::min(log.undecided, *t);
    onward.t_min = *t + step;
  }
}

Side TreeSolid::side_of(const Box3& box) const {
  const Interval f = marrow::value(tracer_.tree(), places_in(box));
  if (f.hi < 1 - field_error()) return Side::Outside;
  return f.lo > 1 + field_error() ? Side::Inside : Side::Unknown;
}

// Of sums in a part of space (field/tree/README.md), with a margin.
double TreeSolid::field_error() const { return holds_blends_ ? 1e-6 : 1e-10; }

// The shortest of growing steps, by the field itself.
std::optional<Vec3d> TreeSolid::start_inside(const HitToDescribe& of) const {
  const SurfaceHit& hit = *of.hit;
  const double first = length(hit.outside - hit.position);
  const GrowingSteps steps{first, 4, std::max(1e-3 * max_component(element_box(of.element).size()), 64 * first)};
  return first_place_along(hit.position, -hit.normal, steps,
                           [&](const Vec3d& p) { return value(p) > 1 + 2 * field_error(); });
}

FieldSample TreeSolid::sample(const Vec3d& p) const { return value_and_gradient(tracer_.tree(), p); }

double TreeSolid::value(const Vec3d& p) const { return marrow::value(tracer_.tree(), p); }

std::size_t TreeSolid::primitive_count() const {
  const BlendInTree* lent = tracer_.lent();
  return leaf_count(tracer_.tree()) - (lent != nullptr ? lent->blend()->size() : 0);
}

}  // namespace marrow
