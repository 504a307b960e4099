#include "renderer/geometry/boolean_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/geometry/tree_solid.h"

namespace marrow {
namespace {

constexpr std::uint32_t none = 0xffffffff;
// In SolidPart::slot, beside that of the operand: all surface in the part counts; not all, or it is not known.
constexpr int all_counts_bit = 1 << 16, some_counts_bit = 1 << 17;
// Boxes are asked with so much of their sides around them: what is found in a part may lie beside it by rounding.
constexpr double beside_box = 1e-3;

constexpr double infinity = std::numeric_limits<double>::infinity();

Box3 around(const Vec3d& p, double rounding) { return Box3{p, p}.padded(rounding); }

// By which places of a ray may be off.
double rounding_at(const Ray& ray, double t) { return 0x1p-50 * (max_component(abs(ray.origin)) + std::fabs(t)); }

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
                           std::vector<std::unique_ptr<OperandSolid>> operands)
    : whole_(std::move(whole)),
      bounds_(bounds),
      expression_(std::move(expression)),
      operands_(std::move(operands)),
      element_of_(operands_.size()) {
  for (std::size_t i = 0; i < operands_.size(); ++i) {
    add_elements(i);
    needed_.push_back(side_if_outside(i, bounds_) == Side::Outside);
    if (operands_[i]->primitive_count() > operands_[largest_]->primitive_count()) largest_ = i;
  }
}

void BooleanSolid::add_elements(std::size_t operand) {
  const OperandSolid& solid = *operands_[operand];
  for (std::uint32_t i = 0; i < solid.element_count(); ++i) {
    const auto counts = counts_in(operand, solid.element_box(i));
    const bool may_count = counts.value_or(true);
    element_of_[operand].push_back(may_count ? static_cast<std::uint32_t>(elements_.size()) : none);
    if (may_count) elements_.push_back({static_cast<std::uint32_t>(operand), i, counts.has_value()});
  }
}

// Whether surface of an operand in a box is that of the whole; nothing where it is so in places, or not known.
std::optional<bool> BooleanSolid::counts_in(std::size_t operand, const Box3& box) const {
  const Box3 around = box.padded(beside_box * max_component(box.size()));
  const BlendInTree* lent = expression_.operands()[operand].lent.get();
  if (!do_overlap(around, bounds_) || (lent != nullptr && lent->decides_around(box))) return false;
  const auto counts = expression_.counts(operand, around, [&](std::size_t other) {
    // What is long to bound has been, as far as its blend and others tell.
    return expression_.operands()[other].lent != nullptr ? Side::Unknown : operands_[other]->side_of(around);
  });
  return lent != nullptr && counts == true && lent->decides(around) != false ? std::nullopt : counts;
}

// Beside a crease, where another operand's surface is nearer than fields are off, each of two crossings might take the
// other to come first, and none would count. There the sides of the whole before and behind the crossing tell.
bool BooleanSolid::counts_at(std::size_t operand, const Ray& ray, double t) const {
  const Vec3d p = ray.at(t);
  const double rounding = rounding_at(ray, t);
  if (const auto& lent = expression_.operands()[operand].lent; lent != nullptr && lent->decides_around({p, p}))
    return false;
  const auto side = [&](std::size_t other) { return side_of_operand(other, p, rounding); };
  if (const auto counts = expression_.counts(operand, around(p, rounding), side)) return *counts;
  const Side before = side_along(ray, t, -1), behind = side_along(ray, t, 1);
  if (before == Side::Outside && behind == Side::Inside && is_entered_later(operand, ray, t)) return false;
  return before != behind || before == Side::Unknown;
}

// Whether the whole is entered behind a crossing, by another one: where this operand stands clearly on its new side, so
// that the other's crossing will count.
bool BooleanSolid::is_entered_later(std::size_t operand, const Ray& ray, double t) const {
  constexpr int halvings = 30;
  const double away = max_component(abs(ray.origin)) + std::fabs(t) + max_component(bounds_.size());
  double before = t, entered = t;
  for (double step = 0x1p-48 * away; value(ray.at(entered)) < 1; step *= 2) {
    if (step > away) return false;
    before = entered;
    entered = t + step;
  }
  for (int i = 0; i < halvings && before < entered; ++i) {
    const double middle = 0.5 * (before + entered);
    (value(ray.at(middle)) < 1 ? before : entered) = middle;
  }
  return entered > t && side_of_operand(operand, ray.at(entered), rounding_at(ray, t)) != Side::Unknown;
}

// At the first of growing steps from t where it is certain.
Side BooleanSolid::side_along(const Ray& ray, double t, double way) const {
  const double size = max_component(bounds_.size()), longest = 1e-3 * size, rounding = rounding_at(ray, t);
  for (double step = 4 * rounding + 0x1p-48 * size; step < longest; step *= 2)
    if (const Side side = side_of_whole(ray.at(t + way * step), rounding); side != Side::Unknown) return side;
  return Side::Unknown;
}

// Unknown where fields, and places by what `rounding` they have, are off by more than it is from the surface.
Side BooleanSolid::side_of_operand(std::size_t operand, const Vec3d& p, double rounding) const {
  constexpr double near = 1e-3;
  const OperandSolid& solid = *operands_[operand];
  if (const Side side = solid.clear_side(p); side != Side::Unknown) return side;
  const double f = solid.value(p);
  double error = solid.field_error();
  if (std::fabs(f - 1) < near) error += rounding * length(solid.sample(p).gradient);
  if (f < 1 - error) return Side::Outside;
  return f > 1 + error ? Side::Inside : Side::Unknown;
}

Side BooleanSolid::side_of_whole(const Vec3d& p, double rounding) const {
  return expression_.side(around(p, rounding), [&](std::size_t i) { return side_of_operand(i, p, rounding); });
}

Box3 BooleanSolid::element_box(std::size_t element) const {
  const Element& e = elements_[element];
  return operands_[e.operand]->element_box(e.element);
}

FieldSample BooleanSolid::sample(const Vec3d& p) const {
  using X = Jet<double, 3>;
  const X f = marrow::value(whole_, Vec3<X>{X::variable(p.x, 0), X::variable(p.y, 1), X::variable(p.z, 2)});
  return {.value = f.value, .gradient = {f.slope[0], f.slope[1], f.slope[2]}};
}

double BooleanSolid::value(const Vec3d& p) const { return marrow::value(whole_, p); }

Side BooleanSolid::clear_side(const Vec3d& p) const {
  constexpr double clearly = 1e-3;
  return expression_.side(around(p, 0), [&](std::size_t i) {
    const SetExpression::Operand& operand = expression_.operands()[i];
    if (operand.blend != nullptr) return operands_[i]->clear_side(p);
    if (operand.lent != nullptr) return Side::Unknown;
    const double f = operands_[i]->value(p);
    if (f < 1 - clearly) return Side::Outside;
    return f > 1 + clearly ? Side::Inside : Side::Unknown;
  });
}

// That of the whole where the operand is outside, whatever the others are.
Side BooleanSolid::side_if_outside(std::size_t operand, const Box3& where) const {
  return expression_.side(where, [&](std::size_t i) { return i == operand ? Side::Outside : Side::Unknown; });
}

// Whether what is outside the operand is outside the whole there.
bool BooleanSolid::is_needed(std::size_t operand, const Vec3d& place) const {
  if (needed_[operand] || !expression_.is_lent(operand)) return needed_[operand];
  return side_if_outside(operand, around(place, 0)) == Side::Outside;
}

bool BooleanSolid::is_left_by(const Ray& ray) const {
  for (std::size_t i = 0; i < operands_.size(); ++i)
    if (is_needed(i, ray.at(ray.t_min)) && operands_[i]->is_left_by(ray)) return true;
  return false;
}

std::vector<SolidPart> BooleanSolid::parts() const {
  std::vector<SolidPart> all;
  for (std::size_t i = 0; i < operands_.size(); ++i)
    for (SolidPart part : operands_[i]->parts()) {
      const std::uint32_t element = element_of_[i][part.element];
      if (element == none) continue;
      // Cells are told as crossing() tells them, so that a ray is searched for in the same ones.
      if (const auto cell = operands_[i]->cell_box(part); cell && !elements_[element].all_counts) {
        const auto counts = counts_in(i, *cell);
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
  if (!of.all_counts || !expression_.is_lent(of.operand)) return of.all_counts && needed_[of.operand];
  const Vec3d begin = ray.at(ray.t_min);
  return !bounds_.contains(begin) || is_needed(of.operand, begin);
}

// Alone the operand is traced by all its means. Rays that begin inside it may be outside the whole, and so are followed
// from side to side.
std::optional<double> BooleanSolid::hit(const OperandPart& of, const Ray& ray, bool any, ElementLog& log) const {
  if (!has_met_before(of, ray)) return crossing(of, ray, log);
  ElementLog alone = log;
  if (of.operand != largest_) alone.outside_from = infinity;
  const std::size_t visits_before = log.visits == nullptr ? 0 : log.visits->size();
  const auto t = operands_[of.operand]->hit_in_part(of.part, ray, any, alone);
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
                                return of.some_counts ? std::nullopt : counts_in(of.operand, cell);
                              },
                              [&](double t) { return of.all_counts || counts_at(of.operand, ray, t); }};
  return operands_[of.operand]->crossing(of.part, ray, filter, log);
}

bool BooleanSolid::traces_packets() const {
  return operands_[largest_]->traces_packets() && (needed_[largest_] || expression_.is_lent(largest_));
}

// Packets of what is largest, where it is traced alone; the rest ray by ray.
void BooleanSolid::hits_in_parts(std::span<const LanesInPart> parts, const RayPacket& packet, bool any,
                                 PacketLog& log) const {
  const OperandSolid& largest = *operands_[largest_];
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
    operands_[operand]->describe(std::span(of_operand).first(count));
    for (std::size_t i = 0; i < count; ++i) complete(operand, of_operand[i], elements_[hits[done + i].element]);
    done += count;
  }
}

// From the operand's hit to that of the whole.
void BooleanSolid::complete(std::size_t operand, const HitToDescribe& of, const Element& element) const {
  SurfaceHit& hit = *of.hit;
  const bool taken_away = expression_.is_taken_away(operand);
  const Side start = taken_away ? Side::Inside : Side::Outside;
  bool is_sure = true;
  if (taken_away) {
    const auto inside = operands_[operand]->start_inside(of);
    is_sure = inside.has_value();
    hit.outside = inside.value_or(hit.position);
    hit.normal = -hit.normal;
    hit.around = {};
  }
  if (is_sure && element.all_counts) return;
  const auto side_at_start = [&](std::size_t i) {
    return i == operand && is_sure ? start : side_of_operand(i, hit.outside, 0);
  };
  if (expression_.side(around(hit.outside, 0), side_at_start) != Side::Outside) free_start(*of.ray, hit);
}

// To one of several sides, the first of growing steps that is outside the whole.
void BooleanSolid::free_start(const Ray& ray, SurfaceHit& hit) const {
  const Vec3d normal = hit.normal, back = -ray.direction.vec();
  const Frame frame = Frame::around(hit.normal);
  const double size = max_component(bounds_.size()), rounding = 0x1p-48 * (largest_coordinate(bounds_) + size),
               first = std::max(length(hit.outside - hit.position), rounding),
               longest = std::max(1e-3 * size, 64 * first);
  for (const Vec3d& way : {normal, normal + back, back, frame.to_world({1, 0, 1}), frame.to_world({-1, 0, 1}),
                           frame.to_world({0, 1, 1}), frame.to_world({0, -1, 1})})
    for (double step = first; step < longest; step *= 4)
      if (const Vec3d p = hit.position + way * step; side_of_whole(p, 0) == Side::Outside) {
        hit.outside = p;
        hit.around = {};
        return;
      }
}

std::size_t BooleanSolid::primitive_count() const {
  std::size_t count = 0;
  for (const auto& operand : operands_) count += operand->primitive_count();
  return count;
}

std::size_t BooleanSolid::bytes() const {
  std::size_t bytes = elements_.capacity() * sizeof(Element) + bytes_of(whole_);
  for (const auto& operand : operands_) bytes += operand->bytes();
  return bytes;
}

}  // namespace marrow
