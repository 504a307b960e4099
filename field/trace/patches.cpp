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
constexpr float accurate_enough = 0.15F, useless = 0.3F;
constexpr int deepest = 2;

struct Errors {
  float field = 0, gradient = 0;
};

struct Cube {
  float center[3], half;

  Cube octant(int i) const {
    Cube c{.center = {}, .half = 0.5F * half};
    for (int k = 0; k < 3; ++k) c.center[k] = center[k] + (i >> k & 1 ? c.half : -c.half);
    return c;
  }
};

void add_lattice_errors(const float* group, int groups, int exponent, const LatticeError& table, const Cube& cube,
                        Errors& errors) {
  const float per_half = 1 / cube.half;
  float scale = 1;
  for (int i = 0; i < exponent; ++i) scale *= per_half;
  for (int k = 0; k < groups; ++k, group += floats_per_group)
    for (int lane = 0; lane < lanes; ++lane) {
      const float* s = group + lane;
      if (!(s[48] > 0)) continue;  // unused
      const float dx = (s[0] - cube.center[0]) * per_half, dy = (s[16] - cube.center[1]) * per_half,
                  dz = (s[32] - cube.center[2]) * per_half;
      const LatticeError::Bound e = table.at(dx * dx + dy * dy + dz * dz);
      errors.field += s[48] * scale * e.field;
      errors.gradient += s[48] * scale * s[64] * per_half * e.gradient;
    }
}

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
  return {scale * second[0],
          scale * std::sqrt(second[1] * second[1] + second[2] * second[2] + second[3] * second[3])};
}

// Box and plane around what is included.
struct Fit {
  float lower[3] = {infinity, infinity, infinity}, upper[3] = {-infinity, -infinity, -infinity};
  float normal[3] = {}, offset = -1e30F;

  bool empty() const { return !(lower[0] <= upper[0]); }

  void include(const Cube& cube) {
    float top = 0;
    for (int k = 0; k < 3; ++k) {
      const float low = cube.center[k] - cube.half, high = cube.center[k] + cube.half;
      lower[k] = std::min(lower[k], low);
      upper[k] = std::max(upper[k], high);
      top += normal[k] * (normal[k] > 0 ? high : low);
    }
    offset = std::max(offset, top);
  }

  // `normal` of length 1, or 0.
  void set_normal(const float* gradient) {
    const float length2 = gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
    const float scale = length2 > 0 ? -1 / std::sqrt(length2) : 0;
    for (int k = 0; k < 3; ++k) normal[k] = gradient[k] * scale;
  }
};

class Builder {
 public:
  Builder(const FieldLevel& level, int degree, const IsoCurve& iso, const LatticeErrors& tables,
          const BlockKernels& kernels)
      : level_(level), degree_(degree), iso_(iso), view_(iso.view()), tables_(tables), kernels_(kernels) {}

  // Divides a cube; returns the box around the surface in it. The node is appended.
  Fit divide(const Cube& cube, int depth) {
    const std::size_t at = out.nodes.size();
    out.nodes.push_back({});
    PatchNode node{};
    for (int k = 0; k < 3; ++k) node.center[k] = cube.center[k];
    node.half = cube.half;
    Fit all;
    for (int i = 0; i < 8; ++i) {
      const Cube octant = cube.octant(i);
      const Fit fit = fill(node, i, octant, depth);
      for (int k = 0; k < 3; ++k) {
        node.lower[k][i] = fit.empty() ? 0 : fit.lower[k] - overlap;
        node.upper[k][i] = fit.empty() ? 0 : fit.upper[k] + overlap;
        node.normal[k][i] = fit.normal[k];
        all.lower[k] = std::min(all.lower[k], fit.lower[k]);
        all.upper[k] = std::max(all.upper[k], fit.upper[k]);
      }
      node.offset[i] = fit.offset + overlap;
    }
    all.offset = all.empty() ? -1e30F : 1e30F;
    out.nodes[at] = node;
    return all;
  }

  Patches out;

 private:
  bool holds_surface(const Cube& cube) const {
    const BallBounds b = kernels_.ball_bounds(level_, degree_, cube.center, cube.half * 1.7322F);
    if (static_cast<double>(b.f_low) > iso_.critical_field() * 1.00001) return false;
    return b.touches || !iso_.outside(0, static_cast<double>(b.f_high), static_cast<double>(b.g_high));
  }

  Fit fill(PatchNode& node, int octant, const Cube& cube, int depth) {
    if (!holds_surface(cube)) return {};
    Errors e{level_.f_error, level_.g_error};
    add_lattice_errors(level_.sources, level_.curve_groups, degree_, tables_.curves, cube, e);
    add_lattice_errors(level_.sources + static_cast<long>(level_.curve_groups) * floats_per_group, level_.point_groups,
                       degree_ - 1, tables_.points, cube, e);
    const float total = e.field + e.gradient / static_cast<float>(degree_);
    if (!(total < accurate_enough) && depth < deepest) {
      node.child[octant] = static_cast<int>(out.nodes.size());
      return divide(cube, depth + 1);
    }
    if (!(total < useless)) {
      node.polynomial[octant] = PatchNode::by_sources;
      Fit fit;
      fit.include(cube);
      fit.offset = 1e30F;
      return fit;
    }
    return add_patch(node, octant, cube, e);
  }

  Fit add_patch(PatchNode& node, int octant, const Cube& cube, const Errors& e) {
    alignas(64) float values[4 * lattice_stride];
    kernels_.lattice_values(level_, degree_, cube.center, cube.half, values);
    float polynomial[far_floats], x_most = 0, y_most = 0;
    lattice_polynomial(values, polynomial);
    for (int i = 0; i < lattice_nodes; ++i) {
      const float* v = values + 4 * i;
      x_most = std::max(x_most, v[0]);
      y_most = std::max(y_most, std::fabs(v[1]) + std::fabs(v[2]) + std::fabs(v[3]));
    }
    const float f_error = e.field + rounding * x_most, g_error = e.gradient + rounding * y_most;
    const Errors bend = bends(polynomial);
    const std::uint64_t marks = kernels_.lattice_marks(
        view_,
        {bend.field + 2 * f_error, bend.gradient + 2 * g_error, static_cast<float>(1.0001 * iso_.critical_field())},
        values);
    Fit fit;
    if (marks == 0) return fit;
    const float gradient[3] = {polynomial[4], polynomial[8], polynomial[12]};
    fit.set_normal(gradient);
    include(marks, cube, fit);
    node.f_error[octant] = f_error;
    node.g_error[octant] = g_error;
    node.polynomial[octant] = static_cast<int>(out.polynomials.size()) / far_floats;
    out.polynomials.insert(out.polynomials.end(), polynomial, polynomial + far_floats);
    return fit;
  }

  static void include(std::uint64_t marks, const Cube& cube, Fit& fit) {
    const float half = cube.half / cells_per_axis;
    for (; marks != 0; marks &= marks - 1) {
      const int i = __builtin_ctzll(marks);
      const int at[3] = {i % cells_per_axis, i / cells_per_axis % cells_per_axis,
                         i / (cells_per_axis * cells_per_axis)};
      Cube cell{.center = {}, .half = half};
      for (int k = 0; k < 3; ++k)
        cell.center[k] = cube.center[k] - cube.half + half * static_cast<float>(2 * at[k] + 1);
      fit.include(cell);
    }
  }

  const FieldLevel& level_;
  int degree_;
  const IsoCurve& iso_;
  IsoCurve::View view_;
  const LatticeErrors& tables_;
  const BlockKernels& kernels_;
};

}  // namespace

Patches make_patches(const FieldLevel& level, int degree, const IsoCurve& iso, const LatticeErrors& tables,
                     const BlockKernels& kernels) {
  Builder builder(level, degree, iso, tables, kernels);
  const Fit fit = builder.divide({.center = {0, 0, 0}, .half = 1}, 1);
  std::copy_n(fit.lower, 3, builder.out.lower);
  std::copy_n(fit.upper, 3, builder.out.upper);
  return std::move(builder.out);
}

}  // namespace marrow
