#include "field/trace/patches.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "field/trace/far_field.h"
#include "field/trace/iso_curve.h"

namespace marrow {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int cells_per_axis = lattice_side - 1;

// Boxes and planes overlap by this much of a block's half side, far more than the rounding of rays in float.
constexpr float overlap = 1e-4F;

// Sums of up to 2000 positive floats, their interpolation (the weights of 5 nodes add up to 2.2 per axis) and the
// change to powers, relative to the largest value.
constexpr float rounding = 5e-5F;

// An octant is divided when its polynomial could be off by more than this in C, down to `deepest` divisions of a block.
// An error of `useless` leaves nothing to be told.
constexpr float accurate_enough = 0.1F, useless = 0.3F;
constexpr int deepest = 2;

struct Errors {
  float field = 0, gradient = 0;
};

// How far a polynomial can rise above all corners of a cell of the lattice: by the error of interpolation between
// corners, the sum over axes of side^2 / 8 times the largest second derivative. |G| by the length of that of its
// components.
Errors bends(const float* polynomial) {
  float second[4] = {};
  for (std::size_t i = 4; i < far_monomials; ++i) {
    const Monomial& m = monomials[i];
    const auto factor = static_cast<float>(m.a * (m.a - 1) + m.b * (m.b - 1) + m.c * (m.c - 1));
    for (std::size_t k = 0; k < 4; ++k) second[k] += factor * std::fabs(polynomial[4 * i + k]);
  }
  constexpr float side = 2.0F / cells_per_axis, scale = 1.01F * side * side / 8;
  return {scale * second[0], scale * std::sqrt(second[1] * second[1] + second[2] * second[2] + second[3] * second[3])};
}

// Box and plane around the marked cells of a lattice.
class Fit {
 public:
  Fit(const Cube& cube, const float* polynomial) : cube_(cube) {
    const float gradient[3] = {polynomial[4], polynomial[8], polynomial[12]};
    const float length2 = gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
    const float scale = length2 > 0 ? -1 / std::sqrt(length2) : 0;
    for (int k = 0; k < 3; ++k) normal_[k] = gradient[k] * scale;
  }

  void include(int cell) {
    const float side = 2 * cube_.half / cells_per_axis;
    const int at[3] = {cell % cells_per_axis, cell / cells_per_axis % cells_per_axis,
                       cell / (cells_per_axis * cells_per_axis)};
    float top = 0;
    for (int k = 0; k < 3; ++k) {
      const float low = cube_.center[k] - cube_.half + side * static_cast<float>(at[k]), high = low + side;
      lower_[k] = std::min(lower_[k], low);
      upper_[k] = std::max(upper_[k], high);
      top += normal_[k] * (normal_[k] > 0 ? high : low);
    }
    offset_ = std::max(offset_, top);
  }

  void write(Patch& out) const {
    for (int k = 0; k < 3; ++k) {
      out.lower[k] = lower_[k] - overlap;
      out.upper[k] = upper_[k] + overlap;
      out.normal[k] = normal_[k];
    }
    out.offset = offset_ + overlap;
  }

 private:
  const Cube& cube_;
  float lower_[3] = {infinity, infinity, infinity}, upper_[3] = {-infinity, -infinity, -infinity};
  float normal_[3], offset_ = -infinity;
};

void cover(const Cube& cube, Patch& out) {
  for (int k = 0; k < 3; ++k) {
    out.lower[k] = cube.center[k] - cube.half - overlap;
    out.upper[k] = cube.center[k] + cube.half + overlap;
    out.normal[k] = 0;
    out.center[k] = cube.center[k];
  }
  out.offset = 1e30F;
  out.half = cube.half;
}

// `errors`: of the interpolation.
void make_polynomial(const PatchSource& source, const Cube& cube, const Errors& errors, Patch& out) {
  alignas(64) float values[4 * lattice_stride];
  source.kernels.lattice_values(source.level, source.degree, cube.center, cube.half, values);
  lattice_polynomial(values, out.polynomial);
  float x_most = 0, y_most = 0;
  for (int i = 0; i < lattice_nodes; ++i) {
    const float* v = values + 4 * i;
    x_most = std::max(x_most, v[0]);
    y_most = std::max(y_most, std::fabs(v[1]) + std::fabs(v[2]) + std::fabs(v[3]));
  }
  out.f_error = source.level.f_error + errors.field + rounding * x_most;
  out.g_error = source.level.g_error + errors.gradient + rounding * y_most;
  const Errors bend = bends(out.polynomial);
  const std::uint64_t marks =
      source.kernels.lattice_marks(source.iso.view(),
                                   {bend.field + 2 * out.f_error, bend.gradient + 2 * out.g_error,
                                    static_cast<float>(1.0001 * source.iso.critical_field())},
                                   values);
  if (marks == 0) return;
  out.kind = Patch::Kind::Smooth;
  Fit fit(cube, out.polynomial);
  for (std::uint64_t left = marks; left != 0; left &= left - 1) fit.include(__builtin_ctzll(left));
  fit.write(out);
}

bool holds_surface(const CubeBounds& b, const IsoCurve& iso) {
  if (static_cast<double>(b.f_low) > iso.critical_field() * 1.00001) return false;
  return b.touches || !iso.outside(0, static_cast<double>(b.f_high), static_cast<double>(b.g_high));
}

}  // namespace

struct OctantPatches::Owned {
  Patch patch;
  std::unique_ptr<const OctantPatches> octants;
};

OctantPatches::OctantPatches(const PatchSource& source, const Cube& cube, int depth)
    : source_(source), cube_(cube), depth_(depth) {
  patch = [](const Octants& octants, int i) -> const Patch& {
    const auto& self = static_cast<const OctantPatches&>(octants);
    return self.patches_[i].get([&] { return self.make(i); }).patch;
  };
  for (int i = 0; i < 8; ++i) {
    const Cube octant = cube.octant(i);
    const CubeBounds b =
        source.kernels.cube_bounds(source.level, source.degree, source.errors, octant.center, octant.half);
    f_error_[i] = b.f_error;
    g_error_[i] = b.g_error;
    for (int k = 0; k < 3; ++k) {
      boxes.lower[k][i] = octant.center[k] - octant.half - overlap;
      boxes.upper[k][i] = octant.center[k] + octant.half + overlap;
    }
    if (holds_surface(b, source.iso)) boxes.present |= 1U << i;
  }
}

OctantPatches::~OctantPatches() = default;

std::unique_ptr<const OctantPatches::Owned> OctantPatches::make(int octant) const {
  auto out = std::make_unique<Owned>();
  Patch& p = out->patch;
  const Cube cube = cube_.octant(octant);
  cover(cube, p);
  const Errors errors{f_error_[octant], g_error_[octant]};
  const float total = errors.field + errors.gradient / static_cast<float>(source_.degree);
  const bool accurate = source_.polynomials && total < accurate_enough;
  if (!accurate && depth_ < deepest) {
    out->octants = std::make_unique<const OctantPatches>(source_, cube, depth_ + 1);
    p.octants = out->octants.get();
    p.kind = p.octants->boxes.present != 0 ? Patch::Kind::Divided : Patch::Kind::Empty;
  } else if (!source_.polynomials || !(total < useless)) {
    p.kind = Patch::Kind::Sources;
  } else {
    make_polynomial(source_, cube, errors, p);
  }
  return out;
}

}  // namespace marrow
