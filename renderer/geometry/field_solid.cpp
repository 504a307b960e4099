#include "renderer/geometry/field_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace marrow {
namespace {

// Rays of a packet in the blend's coordinates. Kept by each thread: it is large, and few lanes may be in use.
struct InBlend {
  std::vector<PartRays> places;
  RayPacket packet;
  CellHits cells;
  std::array<double, RayPacket::size> stretch;      // as in LocalRay
  std::array<std::size_t, RayPacket::size> visits;  // before
};
InBlend& in_blend() {
  thread_local const auto own = std::make_unique<InBlend>();
  return *own;
}

std::size_t visits_so_far(const ElementLog& log) { return log.visits == nullptr ? 0 : log.visits->size(); }

}  // namespace

Result<std::unique_ptr<FieldSolid>> FieldSolid::make(PlacedBlend part, MaterialId of_object,
                                                     const TraceOptions& options) {
  auto tracer = BlendTracer::make(std::move(part.blend), options);
  if (!tracer) return tracer.why();
  return std::unique_ptr<FieldSolid>(
      new FieldSolid(std::move(*tracer), part.world_from_local, part.local_from_world, of_object));
}

std::unique_ptr<FieldSolid> FieldSolid::placed_again(const PlacedBlend& part, MaterialId of_object) const {
  return std::unique_ptr<FieldSolid>(new FieldSolid(tracer_, part.world_from_local, part.local_from_world, of_object));
}

FieldSolid::FieldSolid(std::shared_ptr<const BlendTracer> tracer, const Affine& world_from_local,
                       const Affine& local_from_world, MaterialId of_object)
    : tracer_(std::move(tracer)),
      world_from_local_(world_from_local),
      local_from_world_(local_from_world),
      in_world_(world_from_local == Affine{}),
      material_(of_object) {}

Box3 FieldSolid::element_box(std::size_t element) const { return to_world(tracer_->tile_box(element)); }

// The skeletons and one radius: surfaces bulge further only where skeletons are dense.
Box3 FieldSolid::extent() const {
  const Box3 skeletons = skeleton_bounds(tracer_->field());
  return skeletons.empty() ? skeletons : to_world(skeletons.padded(largest_radius(tracer_->field())));
}

Box3 FieldSolid::reach() const {
  const Box3& tiles = tracer_->bounds();
  return tiles.empty() ? tiles : to_world(tiles);
}

FieldSample FieldSolid::sample(const Vec3d& p) const {
  const BlendSample s = evaluate(tracer_->field(), in_world_ ? p : local_from_world_.point(p));
  return {.value = s.corrected,
          .gradient = in_world_ ? s.corrected_gradient : local_from_world_.transposed(s.corrected_gradient)};
}

double FieldSolid::value(const Vec3d& p) const {
  return corrected_value(tracer_->field(), in_world_ ? p : local_from_world_.point(p));
}

Side FieldSolid::clear_side(const Vec3d& p) const {
  return tracer_->clear_side(in_world_ ? p : local_from_world_.point(p));
}

bool FieldSolid::is_left_by(const Ray& ray) const {
  return ray.around != nullptr && tracer_->leaves_surface(to_local(ray).ray);
}

Box3 FieldSolid::to_world(const Box3& local) const { return in_world_ ? local : world_from_local_.box_around(local); }

// Its end is raised by more than products and quotients round: the exact one is asked for in the world's t.
FieldSolid::LocalRay FieldSolid::to_local(const Ray& ray) const {
  if (in_world_) return {ray, 1};
  const Vec3d direction = local_from_world_.vector(ray.direction);
  const double stretch = length(direction), end = ray.t_max * stretch;
  return {{local_from_world_.point(ray.origin), UnitVec3::unchecked(direction / stretch), ray.t_min * stretch,
           end + std::fabs(end) * 0x1p-50, ray.around},
          stretch};
}

double FieldSolid::crossing_length(std::size_t, const Ray& ray, double t) const {
  const auto [local, stretch] = to_local(ray);
  return tracer_->crossing_length(local.at(t * stretch)) / stretch;
}

void FieldSolid::to_world(const CellLog& log, double stretch, std::size_t visits_before, ElementLog& out) const {
  out.enter = log.enter;
  out.undecided = log.undecided;
  out.outside_from = log.outside_from;
  out.begins_inside = log.side == Side::Inside;
  if (in_world_) return;
  out.enter /= stretch;
  out.undecided /= stretch;
  out.outside_from /= stretch;
  if (out.visits == nullptr) return;
  for (std::size_t i = visits_before; i < out.visits->size(); ++i) (*out.visits)[i].begin /= stretch;
}

template <class Place>
std::optional<double> FieldSolid::traced(const Place& place, const Ray& ray, bool any, ElementLog& log) const {
  const auto [local, stretch] = to_local(ray);
  CellLog cell;
  cell.outside_from = log.outside_from * stretch;
  cell.visits = log.visits;
  const std::size_t before = visits_so_far(log);
  const auto found = tracer_->first_hit(place, local, any, cell);
  to_world(cell, stretch, before, log);
  if (!found) return {};
  const double t = std::max(ray.t_min, found->t / stretch);
  if (t > ray.t_max) return {};
  log.place = found->block;
  return t;
}

std::optional<double> FieldSolid::hit(std::size_t element, const Ray& ray, bool any, ElementLog& log) const {
  const auto t = traced(element, ray, any, log);
  if (!any) log.begins_inside = false;  // the element has been told
  return t;
}

std::optional<double> FieldSolid::hit_in_part(const SolidPart& part, const Ray& ray, bool any, ElementLog& log) const {
  if (part.within == nullptr) return hit(part.element, ray, any, log);
  return traced(traced_part(part), ray, any, log);
}

std::optional<Box3> FieldSolid::cell_box(const SolidPart& part) const {
  const auto box = BlendTracer::cell_box(traced_part(part));
  return box ? std::optional(to_world(*box)) : std::nullopt;
}

std::optional<double> FieldSolid::crossing(const SolidPart& part, const Ray& ray, const CrossingFilter& filter,
                                           ElementLog& log) const {
  const auto [local, stretch] = to_local(ray);
  CellLog cell;
  cell.visits = log.visits;
  const std::size_t before = visits_so_far(log);
  const auto in_world = [&](double t) { return std::max(ray.t_min, t / stretch); };
  const CrossingFilter in_blend{[&](const Box3& box) { return filter.counts_in(to_world(box)); },
                                [&](double t) { return filter.counts_at(in_world(t)); }};
  const auto found = tracer_->first_crossing(traced_part(part), local, in_blend, cell);
  to_world(cell, stretch, before, log);
  log.begins_inside = false;
  if (!found || in_world(found->t) > ray.t_max) return {};
  log.place = found->block;
  return in_world(found->t);
}

Side FieldSolid::side_of(const Box3& box) const {
  return tracer_->clear_side(in_world_ ? box : local_from_world_.box_around(box));
}

std::optional<Vec3d> FieldSolid::start_inside(const HitToDescribe& of) const {
  const Vec3d& position = of.hit->position;
  const SurfaceQuery hit{static_cast<const Block*>(of.place), in_world_ ? position : local_from_world_.point(position)};
  const UnitVec3 normal = in_world_ ? of.hit->normal : normalize(world_from_local_.transposed(of.hit->normal));
  const auto place = tracer_->inside_beside(hit, normal);
  if (!place || in_world_) return place;
  return world_from_local_.point(*place);
}

void FieldSolid::hits_in_parts(std::span<const LanesInPart> parts, const RayPacket& packet, bool any,
                               PacketLog& log) const {
  InBlend& b = in_blend();
  b.places.clear();
  const bool in_world = std::ranges::all_of(parts, [](const LanesInPart& p) { return of_family(p.solid).in_world_; });
  for (const auto& [solid, part, lanes] : parts) {
    b.places.push_back({traced_part(*part), lanes});
    lanes.for_each([&](std::size_t i) {
      b.stretch[i] = 1;
      if (!in_world) {
        const LocalRay local = of_family(solid).to_local(packet.ray(i));
        b.packet.set(i, local.ray);
        b.stretch[i] = local.stretch;
      }
      b.cells.log[i] = {.outside_from = log.lanes[i].outside_from * b.stretch[i], .visits = log.lanes[i].visits};
      b.visits[i] = visits_so_far(log.lanes[i]);
    });
  }
  tracer_->first_hits(b.places, in_world ? packet : b.packet, any, b.cells);
  for (const auto& [solid, part, lanes] : parts)
    lanes.for_each([&](std::size_t i) {
      const FieldSolid& of = of_family(solid);
      of.to_world(b.cells.log[i], b.stretch[i], b.visits[i], log.lanes[i]);
      if (part->within == nullptr && !any) log.lanes[i].begins_inside = false;  // as of an element in hit()
      const CellHit& hit = b.cells.hit[i];
      log.lanes[i].place = hit.block;
      const double t = std::max(packet.t_min[i], of.in_world_ ? hit.t : hit.t / b.stretch[i]);
      const bool met = hit.block != nullptr && t <= packet.t_max[i];
      log.t[i] = met ? t : std::numeric_limits<double>::infinity();
    });
}

std::vector<SolidPart> FieldSolid::parts() const {
  const std::vector<TracePart> traced = tracer_->parts();
  std::vector<SolidPart> parts;
  parts.reserve(traced.size());
  for (const TracePart& p : traced) parts.push_back({p.tile, to_world(p.box), p.within, p.slot});
  return parts;
}

void FieldSolid::describe(std::span<const HitToDescribe> hits) const {
  constexpr std::size_t most = 64;  // of them on the stack
  for (; hits.size() > most; hits = hits.subspan(most)) describe(hits.first(most));
  std::array<SurfaceQuery, most> asked;
  std::array<SurfacePoint, most> found;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Vec3d& position = hits[i].hit->position;
    asked[i] = {static_cast<const Block*>(hits[i].place), in_world_ ? position : local_from_world_.point(position)};
  }
  tracer_->surfaces_at(std::span(asked).first(hits.size()), std::span(found).first(hits.size()));
  for (std::size_t i = 0; i < hits.size(); ++i) {
    SurfaceHit& hit = *hits[i].hit;
    const auto& [normal, outside, around] = found[i];
    hit.around = around;
    hit.normal = in_world_ ? normal : normalize(local_from_world_.transposed(normal));
    hit.outside = in_world_ ? outside : world_from_local_.point(outside);
    const MaterialId own = tracer_->material_at(asked[i].position);
    hit.material = own.valid() ? own : material_;
  }
}

}  // namespace marrow
