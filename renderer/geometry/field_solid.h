// One placed blend as a solid: its elements are the tiles of its tracer.
#pragma once

#include <memory>

#include "field/math/affine.h"
#include "field/program/field_program.h"
#include "field/trace/blend_tracer.h"
#include "renderer/geometry/operand_solid.h"

namespace marrow {

class FieldSolid final : public OperandSolid {
 public:
  static Result<std::unique_ptr<FieldSolid>> make(PlacedBlend, MaterialId of_object, const TraceOptions&);
  /// The same blend at another place, or with another material; the tracer is shared.
  std::unique_ptr<FieldSolid> placed_again(const PlacedBlend&, MaterialId of_object) const;

  std::size_t element_count() const override { return tracer_->tile_count(); }
  Box3 element_box(std::size_t) const override;
  Box3 extent() const override;
  Box3 reach() const override;
  FieldSample sample(const Vec3d&) const override;
  double value(const Vec3d&) const override;
  Side clear_side(const Vec3d&) const override;
  bool is_left_by(const Ray&) const override;
  std::optional<double> hit(std::size_t, const Ray&, bool any, ElementLog&) const override;
  std::vector<SolidPart> parts() const override;
  std::optional<double> hit_in_part(const SolidPart&, const Ray&, bool any, ElementLog&) const override;
  bool traces_packets() const override { return tracer_->traces_packets(); }
  const void* family() const override { return tracer_.get(); }
  void hits_in_parts(std::span<const LanesInPart>, const RayPacket&, bool any, PacketLog&) const override;
  double crossing_length(std::size_t, const Ray&, double t) const override;
  void describe(std::span<const HitToDescribe>) const override;
  std::optional<double> crossing(const SolidPart&, const Ray&, const CrossingFilter&, ElementLog&) const override;
  std::optional<Box3> cell_box(const SolidPart&) const override;
  Side side_of(const Box3&) const override;
  double field_error() const override { return 1e-5; }  // TraceOptions::tolerance
  std::optional<Vec3d> start_inside(const HitToDescribe&) const override;
  std::size_t primitive_count() const override { return tracer_->field().size(); }
  std::size_t bytes() const override { return tracer_->statistics().bytes; }
  const BlendTracer& tracer() const { return *tracer_; }
  TraceStatistics statistics() const { return tracer_->statistics(); }

 private:
  FieldSolid(std::shared_ptr<const BlendTracer>, const Affine& world_from_local, const Affine& local_from_world,
             MaterialId of_object);
  /// The ray in the blend's coordinates; t there is `stretch` times t here.
  struct LocalRay {
    Ray ray;
    double stretch;
  };
  static TracePart traced_part(const SolidPart& part) {
    return {part.element, static_cast<const Tile*>(part.within), part.slot};
  }
  static const FieldSolid& of_family(const Solid* member) { return static_cast<const FieldSolid&>(*member); }
  LocalRay to_local(const Ray&) const;
  void to_world(const CellLog&, double stretch, std::size_t visits_before, ElementLog&) const;
  template <class Place>
  std::optional<double> traced(const Place&, const Ray&, bool any, ElementLog&) const;
  Box3 to_world(const Box3&) const;

  std::shared_ptr<const BlendTracer> tracer_;
  Affine world_from_local_, local_from_world_;
  bool in_world_;
  MaterialId material_;
};

}  // namespace marrow
