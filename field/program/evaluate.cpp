// Takes the largest part of a program.

#include "field/program/field_program.h"

namespace marrow {
namespace {

double value_of(const PlacedBlend& part, const Vec3d& p) {
  return corrected_value(part.blend, part.is_in_world() ? p : part.local_from_world.point(p));
}

struct Largest {
  const PlacedBlend* part = nullptr;
  double value = 0;
};

Largest largest_part(const FieldProgram& program, const Vec3d& p) {
  Largest best;
  for (const PlacedBlend& part : program.parts()) {
    const double v = value_of(part, p);
    if (best.part == nullptr || v > best.value) best = {&part, v};
  }
  return best;
}

}  // namespace

BlendSample evaluate_part(const PlacedBlend& part, const Vec3d& p) {
  if (part.is_in_world()) return evaluate(part.blend, p);
  BlendSample s = evaluate(part.blend, part.local_from_world.point(p));
  s.sum_gradient = part.local_from_world.transposed(s.sum_gradient);
  s.corrected_gradient = part.local_from_world.transposed(s.corrected_gradient);
  return s;
}

FieldSample evaluate(const FieldProgram& program, const Vec3d& p) {
  const auto parts = program.parts();
  if (parts.empty()) return {};
  const PlacedBlend& part = parts.size() == 1 ? parts.front() : *largest_part(program, p).part;
  const BlendSample s = evaluate_part(part, p);
  const Vec3d local = part.is_in_world() ? p : part.local_from_world.point(p);
  return {.value = s.corrected, .gradient = s.corrected_gradient, .material = strongest_material(part.blend, local)};
}

double value(const FieldProgram& program, const Vec3d& p) { return largest_part(program, p).value; }

bool is_single_blend(const FieldProgram& program) { return program.parts().size() == 1; }

}  // namespace marrow
