#include "renderer/geometry/build_surfaces.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "field/base/overloaded.h"
#include "field/math/elementary.h"
#include "field/program/field_program.h"
#include "renderer/geometry/boolean_solid.h"
#include "renderer/geometry/embree_surfaces.h"
#include "renderer/geometry/field_solid.h"
#include "renderer/geometry/mesh_solid.h"
#include "renderer/geometry/tree_parts.h"
#include "renderer/geometry/tree_solid.h"

namespace marrow {
namespace {

// Of the pixels of the film, in the coordinates of a blend.
RaySpacing::View ray_spacing(const SceneDescription& scene, const Affine& local_from_world) {
  const CameraDescription& camera = scene.camera;
  const auto& [x, y, z] = local_from_world.columns;
  RaySpacing::View view{.eye = local_from_world.point(camera.from)};
  if (camera.type == CameraDescription::Type::Perspective)
    view.per_distance = 2 * tan(camera.fov_deg * std::numbers::pi / 360) / scene.film.height;
  else view.constant = camera.height / scene.film.height * std::min({length(x), length(y), length(z)});
  return view;
}

// A tracer that several placements share.
struct Traced {
  const FieldSolid* solid = nullptr;
  std::shared_ptr<RaySpacing> spacing = std::make_shared<RaySpacing>();
};

// Blends under set operations, and for each the tracer of blends; null for what the general tracer has to trace.
struct Combined {
  CombinedBlends blends;
  std::vector<std::shared_ptr<Traced>> tracers;
};

// A field of an object, and for each of its blends the tracer of blends; null for what the general tracer has to trace.
struct Compiled {
  FieldProgram program;
  std::vector<std::shared_ptr<Traced>> tracers;
  std::vector<Combined> combined;  // and the rest of its trees
  std::vector<FieldTree> trees;
};

// Objects one by one into solids and planes; errors of all of them are gathered.
class Builder {
 public:
  Builder(const SceneDescription& scene, const SurfaceOptions& options) : scene_(scene), options_(options) {
    in_world_->views.push_back(ray_spacing(scene, Affine{}));
    in_world_->samples = options.samples;
  }

  std::vector<PlacedSolid> solids;
  std::vector<PlacedPlane> planes;
  Diagnostics problems;

  void add_all() {
    std::vector<Compiled> fields(scene_.objects.size());
    for (std::size_t i = 0; i < scene_.objects.size(); ++i)
      if (const auto* field = std::get_if<FieldDescription>(&scene_.objects[i].shape)) fields[i] = compiled(*field);
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
      const ObjectDescription& object = scene_.objects[i];
      std::visit(Overloaded{[&](const FieldDescription&) { add(std::exchange(fields[i], {}), object, ObjectId{i}); },
                            [&](const PlaneShape& p) {
                              planes.push_back({p.point, normalize(p.normal), object.material, ObjectId{i}});
                            },
                            [&](const MeshShape& m) {
                              solids.push_back({std::make_unique<MeshSolid>(m, object.material), ObjectId{i}});
                            }},
                 object.shape);
    }
  }

 private:
  // A tracer has to know of all placements before it is made.
  Compiled compiled(const FieldDescription& description) {
    auto program = compile_surface(description);
    if (!program) {
      problems.insert(problems.end(), program.why().begin(), program.why().end());
      return {};
    }
    Compiled field{std::move(*program), {}, {}, {}};
    std::map<std::size_t, std::shared_ptr<Traced>> placed;  // by shape
    for (const PlacedBlend& part : field.program.parts()) {
      // The tracer of blends knows the inverse kernel along lines; the general one takes the others.
      if (!untraceable_part(part.blend).empty()) {
        field.tracers.push_back(nullptr);
        continue;
      }
      std::shared_ptr<Traced> alone;
      auto& same = part.shared != 0 ? shared_[part.shared] : part.shape != 0 ? placed[part.shape] : alone;
      place(same, part.local_from_world);
      field.tracers.push_back(same);
    }
    for (const FieldTree& tree : field.program.trees()) add_tree(tree, field);
    return field;
  }

  void place(std::shared_ptr<Traced>& same, const Affine& local_from_world) {
    if (same == nullptr) same = std::make_shared<Traced>();
    same->spacing->views.push_back(ray_spacing(scene_, local_from_world));
    same->spacing->samples = options_.samples;
  }

  // Blends under set operations have tracers of their own, however often they are placed.
  void add_tree(const FieldTree& tree, Compiled& field) {
    std::map<const BlendField*, std::shared_ptr<Traced>> placed;
    TreeParts parts = take_apart(tree);
    for (CombinedBlends& blends : parts.combined) {
      Combined made{std::move(blends), {}};
      for (const SetExpression::Operand& operand : made.blends.expression.operands()) {
        made.tracers.push_back(nullptr);
        if (operand.blend == nullptr) continue;
        place(placed[operand.blend.get()], operand.world_from_blend.inverse());
        made.tracers.back() = placed[operand.blend.get()];
      }
      field.combined.push_back(std::move(made));
    }
    if (parts.rest) field.trees.push_back(std::move(*parts.rest));
  }

  void add(Compiled field, const ObjectDescription& object, ObjectId id) {
    for (std::size_t i = 0; i < field.tracers.size(); ++i) {
      const PlacedBlend& part = field.program.parts()[i];
      Traced* const same = field.tracers[i].get();
      if (same == nullptr) add(tree_solid(tree_of(part), object), object, id);
      else add(field_solid(*same, part, object), object, id);
    }
    for (const Combined& combined : field.combined) add(boolean_solid(combined, object), object, id);
    for (FieldTree& tree : field.trees) add(tree_solid(std::move(tree), object), object, id);
  }

  Result<std::unique_ptr<FieldSolid>> field_solid(Traced& same, const PlacedBlend& part,
                                                  const ObjectDescription& object) {
    if (same.solid != nullptr) return same.solid->placed_again(part, object.material);
    auto made = FieldSolid::make(part, object.material, {.instruction_set = options_.isa, .spacing = same.spacing});
    if (made) same.solid = made->get();
    return made;
  }

  Result<std::unique_ptr<TreeSolid>> tree_solid(FieldTree tree, const ObjectDescription& object) {
    return TreeSolid::make(std::move(tree), object.material, TreeTracer::everywhere, {nullptr, in_world_});
  }

  Result<std::unique_ptr<BooleanSolid>> boolean_solid(const Combined& combined, const ObjectDescription& object) {
    const auto& [whole, bounds, expression] = combined.blends;
    const auto blend_solid = [&](std::size_t i) {
      const SetExpression::Operand& operand = combined.blends.expression.operands()[i];
      const Affine& placed = operand.world_from_blend;
      return as_operand(field_solid(*combined.tracers[i], {*operand.blend, placed, placed.inverse()}, object));
    };
    return BooleanSolid::make(whole, bounds, expression, object.material, blend_solid, in_world_);
  }

  template <class SolidType>
  void add(Result<std::unique_ptr<SolidType>> solid, const ObjectDescription& object, ObjectId id) {
    if (solid) return void(solids.push_back({std::move(*solid), id}));
    for (Diagnostic d : solid.why()) {
      if (d.where.line == 0) d.where = object.where;
      problems.push_back(std::move(d));
    }
  }

  const SceneDescription& scene_;
  const SurfaceOptions& options_;
  std::shared_ptr<RaySpacing> in_world_ = std::make_shared<RaySpacing>();
  std::map<std::size_t, std::shared_ptr<Traced>> shared_;  // by PlacedBlend::shared
};

std::string embree_config(const SurfaceOptions& options, int threads) {
  std::string config = "threads=" + std::to_string(threads);
  const std::string& isa = options.embree_isa.empty() ? options.isa : options.embree_isa;
  if (isa == "sse4") config += ",isa=sse4.2";
  else if (!isa.empty()) config += ",isa=" + isa;
  return config;
}

// Elements make what they need when rays come: a lattice of rays along each axis.
void visit_all_elements(const Solid& solid) {
  constexpr int rays = 12;
  tbb::parallel_for(std::size_t{0}, solid.element_count(), [&](std::size_t element) {
    const Box3 box = solid.element_box(element);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int i = 0; i < rays * rays; ++i) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        Vec3d origin = box.lower, direction{};
        origin[axis] -= box.size()[axis];
        origin[u] += box.size()[u] * (i % rays + 0.5) / rays;
        origin[v] += box.size()[v] * (i / rays + 0.5) / rays;
        direction[axis] = 1;
        ElementLog unused;
        solid.hit(element, {origin, UnitVec3::unchecked(direction)}, false, unused);
      }
  });
}

}  // namespace

Result<std::unique_ptr<Surfaces>> build_surfaces(const SceneDescription& scene, const SurfaceOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const int threads = options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency();
  std::optional<Result<std::unique_ptr<EmbreeSurfaces>>> built;
  Diagnostics problems;
  tbb::task_arena(threads).execute([&] {
    Builder builder(scene, options);
    builder.add_all();
    problems = std::move(builder.problems);
    if (problems.empty() && options.eager)
      for (const PlacedSolid& p : builder.solids) visit_all_elements(*p.solid);
    if (problems.empty())
      built =
          EmbreeSurfaces::make(std::move(builder.solids), std::move(builder.planes), embree_config(options, threads));
  });
  if (!problems.empty()) return problems;
  if (!*built) return built->why();
  (**built)->build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::unique_ptr<Surfaces>(std::move(**built));
}

SurfaceReport report(const Surfaces& surfaces) {
  SurfaceReport r;
  const auto* embree = dynamic_cast<const EmbreeSurfaces*>(&surfaces);
  if (embree == nullptr) return r;
  r.build_seconds = embree->build_seconds;
  std::set<const BlendTracer*> counted;
  const auto add = [&](const Solid& solid) {
    const auto* field = dynamic_cast<const FieldSolid*>(&solid);
    if (field != nullptr && !counted.insert(&field->tracer()).second) return;
    r.bytes += solid.bytes();
    if (field == nullptr) return;
    const TraceStatistics s = field->statistics();
    r.tiles += s.tiles;
    r.cells += s.cells;
    r.blocks += s.blocks;
    r.largest_error = std::max(r.largest_error, s.largest_error);
  };
  for (const PlacedSolid& p : embree->solids()) {
    r.primitives += p.solid->primitive_count();
    const auto* boolean = dynamic_cast<const BooleanSolid*>(p.solid.get());
    if (boolean == nullptr) add(*p.solid);
    else
      for (const auto& operand : boolean->operands()) add(*operand);
  }
  return r;
}

}  // namespace marrow
