#include "renderer/geometry/boolean_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "field/math/growing_steps.h"
#include "renderer/geometry/tree_solid.h"

namespace marrow {
namespace {

constexpr std::uint32_t none = 0xffffffff;
// In SolidPart::slot, beside that of the operand: all surface in the part counts; not all, or it is not known.
constexpr int all_counts_bit = 1 << 16, some_counts_bit = 1 << 17;
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

Result<std::unique_ptr<BooleanSolid>> BooleanSolid::make(FieldTree whole, const Box3& bounds, SetExpression expression,
                                                         MaterialId of_object, const BlendSolid& blend_solid,
                                                         std::shared_ptr<const RaySpacing> spacing) {
  std::vector<std::unique_ptr<OperandSolid>> operands;
  for (std::size_t i = 0; i < expression.operands().size(); ++i) {
    const SetExpression::Operand& operand = expression.operands()[i];
    Result<std::unique_ptr<OperandSolid>> solid =
        operand.blend != nullptr
            ? blend_solid(i)
            : as_operand(TreeSolid::make(operand.tree, of_object, bounds, {operand.lent, spacing}));
    if (!solid) return solid.why();
    operands.push_back(std::move(*solid));
  }
  return std::unique_ptr<BooleanSolid>(
      new BooleanSolid(std::move(whole), bounds, std::move(expression), std::move(operands)));
}

BooleanSolid::BooleanSolid(FieldTree whole, const Box3& bounds, SetExpression expression,
                           std::vector<std::unique_ptr<OperandSolid>> of)
    : sides_(std::move(whole), bounds, std::move(expression), std::move(of)), element_of_(operands().size()) {
  for (std::size_t i = 0; i < operands().size(); ++i) {
    add_elements(i);
    if (operands()[i]->primitive_count() > operands()[largest_]->primitive_count()) largest_ = i;
  }
}

void BooleanSolid::add_elements(std::size_t operand) {
  const OperandSolid& solid = *operands()[operand];
  for (std::uint32_t i = 0; i < solid.element_count(); ++i) {
    const auto counts = sides_.counts_in(operand, solid.element_box(i));
    const bool may_count = counts.value_or(true);
    element_of_[operand].push_back(may_count ? static_cast<std::uint32_t>(elements_.size()) : none);
    if (may_count) elements_.push_back({static_cast<std::uint32_t>(operand), i, counts.has_value()});
  }
}

Box3 BooleanSolid::element_box(std::size_t element) const {
  const Element& e = elements_[element];
  return operands()[e.operand]->element_box(e.element);
}

double BooleanSolid::crossing_length(std::size_t element, const Ray& ray, double t) const {
  const Element& e = elements_[element];
  return operands()[e.operand]->crossing_length(e.element, ray, t);
}

bool BooleanSolid::is_left_by(const Ray& ray) const {
  for (std::size_t i = 0; i < operands().size(); ++i)
    if (sides_.is_needed(i, ray.at(ray.t_min)) && operands()[i]->is_left_by(ray)) return true;
  return false;
}

std::vector<SolidPart> BooleanSolid::parts() const {
  std::vector<SolidPart> all;
  for (std::size_t i = 0; i < operands().size(); ++i)
    for (SolidPart part : operands()[i]->parts()) {
      const std::uint32_t element = element_of_[i][part.element];
      if (element == none) continue;
      // Cells are told as crossing() tells them, so that a ray is searched for in the same ones.
      if (const auto cell = operands()[i]->cell_box(part); cell && !elements_[element].all_counts) {
        const auto counts = sides_.counts_in(i, *cell);
        if (!counts.value_or(true)) continue;
        part.slot |= counts.has_value() ? all_counts_bit : some_counts_bit;
      }
      part.element = element;
      all.push_back(part);
    }
  return all;
}

BooleanSolid::OperandPart BooleanSolid::part_of_operand(const SolidPart& part) const {
  const Element& element = elements_[part.element];
  OperandPart of{element.operand, part, element.all_counts || (part.slot & all_counts_bit) != 0,
                 (part.slot & some_counts_bit) != 0};
  of.part.element = element.element;
  of.part.slot &= ~(all_counts_bit | some_counts_bit);
  return of;
}

std::optional<double> BooleanSolid::hit(std::size_t element, const Ray& ray, bool any, ElementLog& log) const {
  return hit_in_part({.element = element, .box = {}}, ray, any, log);
}

std::optional<double> BooleanSolid::hit_in_part(const SolidPart& part, const Ray& ray, bool any,
                                                ElementLog& log) const {
  return hit(part_of_operand(part), ray, any, log);
}

// Of rays that begin outside the operand, and come into a part of it, where all counts, inside it: whether they have
// met the whole before, so that it matters no more what they meet here. So it is where they have begun outside the
// whole.
bool BooleanSolid::has_met_before(const OperandPart& of, const Ray& ray) const {
  if (!of.all_counts || !expression().is_lent(of.operand))
    return of.all_counts && sides_.is_needed_everywhere(of.operand);
  const Vec3d begin = ray.at(ray.t_min);
  return !sides_.bounds().contains(begin) || sides_.is_needed(of.operand, begin);
}

// Alone the operand is traced by all its means. Rays that begin inside it may be outside the whole, and so are followed
// from side to side.
std::optional<double> BooleanSolid::hit(const OperandPart& of, const Ray& ray, bool any, ElementLog& log) const {
  if (!has_met_before(of, ray)) return crossing(of, ray, log);
  ElementLog alone = log;
  if (of.operand != largest_) alone.outside_from = infinity;
  const std::size_t visits_before = log.visits == nullptr ? 0 : log.visits->size();
  const auto t = operands()[of.operand]->hit_in_part(of.part, ray, any, alone);
  if (alone.begins_inside) {
    if (log.visits != nullptr) log.visits->resize(visits_before);
    return crossing(of, ray, log);
  }
  if (of.operand != largest_) alone.outside_from = log.outside_from;
  log = alone;
  return t;
}

std::optional<double> BooleanSolid::crossing(const OperandPart& of, const Ray& ray, ElementLog& log) const {
  const CrossingFilter filter{[&](const Box3& cell) -> std::optional<bool> {
                                if (of.all_counts) return true;
                                return of.some_counts ? std::nullopt : sides_.counts_in(of.operand, cell);
                              },
                              [&](double t) { return of.all_counts || sides_.counts_at(of.operand, ray, t); }};
  return operands()[of.operand]->crossing(of.part, ray, filter, log);
}

bool BooleanSolid::traces_packets() const {
  return operands()[largest_]->traces_packets() &&
         (sides_.is_needed_everywhere(largest_) || expression().is_lent(largest_));
}

// Packets of what is largest, where it is traced alone; the rest ray by ray.
void BooleanSolid::hits_in_parts(std::span<const LanesInPart> parts, const RayPacket& packet, bool any,
                                 PacketLog& log) const {
  const OperandSolid& largest = *operands()[largest_];
  std::vector<OperandPart> together;
  std::vector<LanesInPart> lanes_together;
  together.reserve(parts.size());
  for (const auto& [solid, part, lanes] : parts) {
    const OperandPart of = part_of_operand(*part);
    LanesInPart by_itself{solid, part, {}}, in_company{&largest, nullptr, {}};
    lanes.for_each([&](std::size_t i) {
      const bool alone = of.operand != largest_ || !has_met_before(of, packet.ray(i));
      (alone ? by_itself : in_company).lanes.add(i);
    });
    if (!by_itself.lanes.empty()) hits_one_by_one(std::span(&by_itself, 1), packet, any, log);
    if (in_company.lanes.empty()) continue;
    together.push_back(of);
    in_company.part = &together.back().part;
    lanes_together.push_back(in_company);
  }
  if (together.empty()) return;
  std::array<std::size_t, RayPacket::size> visits_before;
  for (const auto& [solid, part, lanes] : lanes_together)
    lanes.for_each([&](std::size_t i) {
      const auto* visits = log.lanes[i].visits;
      visits_before[i] = visits == nullptr ? 0 : visits->size();
    });
  largest.hits_in_parts(lanes_together, packet, any, log);
  for (std::size_t k = 0; k < together.size(); ++k)
    lanes_together[k].lanes.for_each([&](std::size_t i) {
      ElementLog& lane = log.lanes[i];
      if (!lane.begins_inside) return;
      if (lane.visits != nullptr) lane.visits->resize(visits_before[i]);
      lane = {.visits = lane.visits};
      log.t[i] = crossing(together[k], packet.ray(i), lane).value_or(infinity);
    });
}

void BooleanSolid::describe(std::span<const HitToDescribe> hits) const {
  constexpr std::size_t most = 64;
  for (std::size_t done = 0; done < hits.size();) {
    const std::size_t operand = elements_[hits[done].element].operand;
    std::array<HitToDescribe, most> of_operand;
    std::size_t count = 0;
    for (; count < most && done + count < hits.size(); ++count) {
      const HitToDescribe& hit = hits[done + count];
      const Element& element = elements_[hit.element];
      if (element.operand != operand) break;
      of_operand[count] = hit;
      of_operand[count].element = element.element;
    }
    operands()[operand]->describe(std::span(of_operand).first(count));
    for (std::size_t i = 0; i < count; ++i) complete(operand, of_operand[i], elements_[hits[done + i].element]);
    done += count;
  }
}

// From the operand's hit to that of the whole.
void BooleanSolid::complete(std::size_t operand, const HitToDescribe& of, const Element& element) const {
  SurfaceHit& hit = *of.hit;
  const bool taken_away = expression().is_taken_away(operand);
  const Side start = taken_away ? Side::Inside : Side::Outside;
  bool is_sure = true;
  if (taken_away) {
    const auto inside = operands()[operand]->start_inside(of);
    is_sure = inside.has_value();
    hit.outside = inside.value_or(hit.position);
    hit.normal = -hit.normal;
    hit.around = {};
  }
  if (is_sure && element.all_counts) return;
  const auto side_at_start = [&](std::size_t i) {
    return i == operand && is_sure ? start : sides_.side_of_operand(i, hit.outside, 0);
  };
  if (expression().side({hit.outside, hit.outside}, side_at_start) != Side::Outside) free_start(*of.ray, hit);
}

// To one of several sides, the first of growing steps that is outside the whole.
void BooleanSolid::free_start(const Ray& ray, SurfaceHit& hit) const {
  const Vec3d normal = hit.normal, back = -ray.direction.vec();
  const Frame frame = Frame::around(hit.normal);
  const double size = max_component(sides_.bounds().size()),
               rounding = 0x1p-48 * (largest_coordinate(sides_.bounds()) + size),
               first = std::max(length(hit.outside - hit.position), rounding);
  const GrowingSteps steps{first, 4, std::max(1e-3 * size, 64 * first)};
  const auto is_outside = [&](const Vec3d& p) { return sides_.side_of_whole(p, 0) == Side::Outside; };
  for (const Vec3d& way : {normal, normal + back, back, frame.to_world({1, 0, 1}), frame.to_world({-1, 0, 1}),
                           frame.to_world({0, 1, 1}), frame.to_world({0, -1, 1})})
    if (const auto start = first_place_along(hit.position, way, steps, is_outside)) {
      hit.outside = *start;
      hit.around = {};
      return;
    }
}

std::size_t BooleanSolid::primitive_count() const {
  std::size_t count = 0;
  for (const auto& operand : operands()) count += operand->primitive_count();
  return count;
}

std::size_t BooleanSolid::bytes() const {
  std::size_t bytes = elements_.capacity() * sizeof(Element) + bytes_of(sides_.whole());
  for (const auto& operand : operands()) bytes += operand->bytes();
  return bytes;
}

}  // namespace marrow
