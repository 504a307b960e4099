// Solids under crisp or sharp set operations: what is inside some of them and outside others.
//
// Its surface consists of pieces of those of its operands. Each of them is traced by itself, where it is not certain
// that the others leave nothing of it; a crossing counts where the whole changes sides with the operand, as the others
// stand there.   [Roth 1982, with the side at a place in the place of intervals along the ray]
// A blend under another operation, such as a soft union, is an operand where it decides by itself; all that stands
// below the operation is one, too, and counts elsewhere.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "field/base/result.h"
#include "renderer/geometry/boolean_sides.h"

namespace marrow {

class BooleanSolid final : public Solid {
 public:
  /// What is made of the blend that is an operand, by its index.
  using BlendSolid = std::function<Result<std::unique_ptr<OperandSolid>>(std::size_t operand)>;
  /// `whole`: the same field as that of the expression; `bounds` hold all that is inside; `spacing` as in TreeDivision.
  /// Errors: those of operands.
  static Result<std::unique_ptr<BooleanSolid>> make(FieldTree whole, const Box3& bounds, SetExpression,
                                                    MaterialId of_object, const BlendSolid&,
                                                    std::shared_ptr<const RaySpacing> spacing = nullptr);

  std::size_t element_count() const override { return elements_.size(); }
  Box3 element_box(std::size_t element) const override;
  Box3 extent() const override { return sides_.bounds(); }
  Box3 reach() const override { return sides_.bounds(); }
  FieldSample sample(const Vec3d& p) const override { return sides_.sample(p); }
  double value(const Vec3d& p) const override { return sides_.value(p); }
  Side clear_side(const Vec3d& p) const override { return sides_.clear_side(p); }
  bool is_left_by(const Ray&) const override;
  std::optional<double> hit(std::size_t, const Ray&, bool any, ElementLog&) const override;
  std::vector<SolidPart> parts() const override;
  std::optional<double> hit_in_part(const SolidPart&, const Ray&, bool any, ElementLog&) const override;
  bool traces_packets() const override;
  void hits_in_parts(std::span<const LanesInPart>, const RayPacket&, bool any, PacketLog&) const override;
  double crossing_length(std::size_t, const Ray&, double t) const override;
  void describe(std::span<const HitToDescribe>) const override;
  std::size_t primitive_count() const override;
  std::size_t bytes() const override;
  const std::vector<std::unique_ptr<OperandSolid>>& operands() const { return sides_.operands(); }

 private:
  // An element of an operand, and whether all of its surface is known to be of the whole.
  struct Element {
    std::uint32_t operand, element;
    bool all_counts;
  };
  // A part of this solid as one of its operand.
  struct OperandPart {
    std::size_t operand;
    SolidPart part;
    // Of the operand's surface in it: whether all of it is surface of the whole; whether only some may be.
    bool all_counts, some_counts;
  };
  BooleanSolid(FieldTree whole, const Box3& bounds, SetExpression, std::vector<std::unique_ptr<OperandSolid>>);
  void add_elements(std::size_t operand);
  OperandPart part_of_operand(const SolidPart&) const;
  bool has_met_before(const OperandPart&, const Ray&) const;
  std::optional<double> hit(const OperandPart&, const Ray&, bool any, ElementLog&) const;
  std::optional<double> crossing(const OperandPart&, const Ray&, ElementLog&) const;
  void complete(std::size_t operand, const HitToDescribe&, const Element&) const;
  void free_start(const Ray&, SurfaceHit&) const;

  const SetExpression& expression() const { return sides_.expression(); }

  BooleanSides sides_;
  std::size_t largest_ = 0;  // operand: what rays know of their beginnings from part to part is of this one
  std::vector<Element> elements_;
  std::vector<std::vector<std::uint32_t>> element_of_;  // of an operand's elements; none: nothing of it counts
};

}  // namespace marrow
