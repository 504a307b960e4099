#include "renderer/geometry/boolean_sides.h"

#include <cmath>
#include <utility>

namespace marrow {
namespace {

// Boxes are asked with so much of their sides around them: what is found in a part may lie beside it by rounding.
constexpr double beside_box = 1e-3;

Box3 around(const Vec3d& p, double rounding) { return Box3{p, p}.padded(rounding); }

// By which places of a ray may be off.
double rounding_at(const Ray& ray, double t) { return 0x1p-50 * (max_component(abs(ray.origin)) + std::fabs(t)); }

}  // namespace

BooleanSides::BooleanSides(FieldTree whole, const Box3& bounds, SetExpression expression,
                           std::vector<std::unique_ptr<OperandSolid>> operands)
    : whole_(std::move(whole)), bounds_(bounds), expression_(std::move(expression)), operands_(std::move(operands)) {
  for (std::size_t i = 0; i < operands_.size(); ++i) needed_.push_back(side_if_outside(i, bounds_) == Side::Outside);
}

FieldSample BooleanSides::sample(const Vec3d& p) const { return value_and_gradient(whole_, p); }

double BooleanSides::value(const Vec3d& p) const { return marrow::value(whole_, p); }

std::optional<bool> BooleanSides::counts_in(std::size_t operand, const Box3& box) const {
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
bool BooleanSides::counts_at(std::size_t operand, const Ray& ray, double t) const {
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
bool BooleanSides::is_entered_later(std::size_t operand, const Ray& ray, double t) const {
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
Side BooleanSides::side_along(const Ray& ray, double t, double way) const {
  const double size = max_component(bounds_.size()), longest = 1e-3 * size, rounding = rounding_at(ray, t);
  for (double step = 4 * rounding + 0x1p-48 * size; step < longest; step *= 2)
    if (const Side side = side_of_whole(ray.at(t + way * step), rounding); side != Side::Unknown) return side;
  return Side::Unknown;
}

Side BooleanSides::side_of_operand(std::size_t operand, const Vec3d& p, double rounding) const {
  constexpr double near = 1e-3;
  const OperandSolid& solid = *operands_[operand];
  if (const Side side = solid.clear_side(p); side != Side::Unknown) return side;
  const double f = solid.value(p);
  double error = solid.field_error();
  if (std::fabs(f - 1) < near) error += rounding * length(solid.sample(p).gradient);
  if (f < 1 - error) return Side::Outside;
  return f > 1 + error ? Side::Inside : Side::Unknown;
}

Side BooleanSides::side_of_whole(const Vec3d& p, double rounding) const {
  return expression_.side(around(p, rounding), [&](std::size_t i) { return side_of_operand(i, p, rounding); });
}

Side BooleanSides::clear_side(const Vec3d& p) const {
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
Side BooleanSides::side_if_outside(std::size_t operand, const Box3& where) const {
  return expression_.side(where, [&](std::size_t i) { return i == operand ? Side::Outside : Side::Unknown; });
}

bool BooleanSides::is_needed(std::size_t operand, const Vec3d& place) const {
  if (needed_[operand] || !expression_.is_lent(operand)) return needed_[operand];
  return side_if_outside(operand, around(place, 0)) == Side::Outside;
}

}  // namespace marrow
