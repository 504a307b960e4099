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
constexpr int sub_cells = lattice_side - 1;  // per axis
constexpr float patch_half = 0.5F;
constexpr int padded_nodes = 128;

// Boxes and planes overlap by this much of a block's half side, far more than the rounding of rays in float.
constexpr float overlap = 1e-4F;

// Sums of up to 2000 positive floats, their interpolation (the weights of 5 nodes add up to 2.2 per axis) and the
// change to powers, relative to the largest value.
constexpr float rounding = 5e-5F;

struct Errors {
  float field = 0, gradient = 0;
};

void add_lattice_errors(const float* group, int groups, int exponent, const LatticeError& table, const float (&c)[3],
                        Errors& errors) {
  constexpr float per_half = 1 / patch_half;
  float scale = 1;
  for (int i = 0; i < exponent; ++i) scale *= per_half;
  for (int k = 0; k < groups; ++k, group += floats_per_group)
    for (int lane = 0; lane < lanes; ++lane) {
      if (!(group[48 + lane] > 0)) continue;  // unused
      const float* s = group + lane;
      const float dx = (s[0] - c[0]) * per_half, dy = (s[16] - c[1]) * per_half, dz = (s[32] - c[2]) * per_half;
      const LatticeError::Bound e = table.at(dx * dx + dy * dy + dz * dz);
      errors.field += s[48] * scale * e.field;
      errors.gradient += s[48] * scale * s[64] * per_half * e.gradient;
    }
}

Errors lattice_errors(const FieldLevel& level, int degree, const LatticeErrors& tables, const float (&c)[3]) {
  Errors e;
  add_lattice_errors(level.sources, level.curve_groups, degree, tables.curves, c, e);
  add_lattice_errors(level.sources + static_cast<long>(level.curve_groups) * floats_per_group, level.point_groups,
                     degree - 1, tables.points, c, e);
  return e;
}

// How far a polynomial can rise above all corners of a sub-cell: by the error of interpolation between corners,
// sum over axes of side^2 / 8 times the largest second derivative. |G| by the length of that of its components.
Errors bends(const float* polynomial) {
  float second[4] = {};
  for (std::size_t i = 4; i < far_monomials; ++i) {
    const Monomial& m = monomials[i];
    const auto factor = static_cast<float>(m.a * (m.a - 1) + m.b * (m.b - 1) + m.c * (m.c - 1));
    for (std::size_t k = 0; k < 4; ++k) second[k] += factor * std::fabs(polynomial[4 * i + k]);
  }
  constexpr float side = 2.0F / sub_cells, scale = 1.01F * side * side / 8;
  return {scale * second[0], scale * std::sqrt(second[1] * second[1] + second[2] * second[2] + second[3] * second[3])};
}

// Values at the nodes of one patch.
struct Nodes {
  alignas(64) float values[4 * padded_nodes];
  float x(int i) const { return values[4 * i]; }
  float y(int i) const {
    const float* g = values + 4 * i + 1;
    return std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  }
};

constexpr int node_index(int i, int j, int k) { return i + lattice_side * j + lattice_side * lattice_side * k; }

// Bit i + 4 j + 16 k for each sub-cell that may hold surface, or lie inside.
std::uint64_t marked_cells(const Nodes& nodes, const IsoCurve& iso, const Errors& raise) {
  float x[lattice_nodes], y[lattice_nodes];
  for (int i = 0; i < lattice_nodes; ++i) {
    x[i] = nodes.x(i);
    y[i] = nodes.y(i);
  }
  std::uint64_t bits = 0;
  for (int cell = 0; cell < sub_cells * sub_cells * sub_cells; ++cell) {
    const int base = node_index(cell % sub_cells, cell / sub_cells % sub_cells, cell / (sub_cells * sub_cells));
    float low = infinity, high = 0, steep = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int i = base + node_index(corner & 1, corner >> 1 & 1, corner >> 2);
      low = std::min(low, x[i]);
      high = std::max(high, x[i]);
      steep = std::max(steep, y[i]);
    }
    const float x_low = std::max(0.0F, low - raise.field);
    if (!iso.outside(static_cast<double>(x_low), static_cast<double>(high + raise.field),
                     static_cast<double>(steep + raise.gradient)))
      bits |= std::uint64_t{1} << cell;
  }
  return bits;
}

// Box and plane around the marked sub-cells.
class Fit {
 public:
  Fit(const float (&center)[3], const float* polynomial) {
    float length2 = 0;
    for (int k = 0; k < 3; ++k) {
      center_[k] = center[k];
      normal_[k] = -polynomial[4 * (1 + k)];
      length2 += normal_[k] * normal_[k];
    }
    const float scale = length2 > 0 ? 1 / std::sqrt(length2) : 0;
    for (float& n : normal_) n *= scale;
  }

  void include(int cell) {
    constexpr float side = 2 * patch_half / sub_cells;
    const int at[3] = {cell % sub_cells, cell / sub_cells % sub_cells, cell / (sub_cells * sub_cells)};
    float top = 0;
    for (int k = 0; k < 3; ++k) {
      const float low = center_[k] - patch_half + side * static_cast<float>(at[k]), high = low + side;
      lower_[k] = std::min(lower_[k], low);
      upper_[k] = std::max(upper_[k], high);
      top += normal_[k] * (normal_[k] > 0 ? high : low);
    }
    offset_ = std::max(offset_, top);
  }

  void write(int patch, Patches& out) const {
    for (int k = 0; k < 3; ++k) {
      out.lower[k][patch] = lower_[k] - overlap;
      out.upper[k][patch] = upper_[k] + overlap;
      out.normal[k][patch] = normal_[k];
    }
    out.offset[patch] = offset_ + overlap;
  }

 private:
  float center_[3], normal_[3];
  float lower_[3] = {infinity, infinity, infinity}, upper_[3] = {-infinity, -infinity, -infinity};
  float offset_ = -infinity;
};

// No surface: nothing is below the plane.
void write_empty(int patch, Patches& out) {
  for (int k = 0; k < 3; ++k) out.lower[k][patch] = out.upper[k][patch] = out.normal[k][patch] = 0;
  out.offset[patch] = -1e30F;
}

void write_whole(int patch, const float (&center)[3], Patches& out) {
  for (int k = 0; k < 3; ++k) {
    out.lower[k][patch] = center[k] - patch_half - overlap;
    out.upper[k][patch] = center[k] + patch_half + overlap;
    out.normal[k][patch] = 0;
  }
  out.offset[patch] = 1e30F;
}

}  // namespace

void build_patches(const FieldLevel& level, int degree, const IsoCurve& iso, const LatticeErrors& tables,
                   const BlockKernels& kernels, float* polynomials, Patches& out) {
  out.polynomials = polynomials;
  out.by_sources = 0;
  for (int patch = 0; patch < patch_count; ++patch) {
    float center[3];
    for (int k = 0; k < 3; ++k) center[k] = patch >> k & 1 ? patch_half : -patch_half;
    const Errors lattice = lattice_errors(level, degree, tables, center);
    // An error of a third of the field leaves nothing to be told.
    constexpr float useless = 0.3F;
    if (!(lattice.field + lattice.gradient / static_cast<float>(degree) < useless)) {
      out.by_sources |= 1U << patch;
      write_whole(patch, center, out);
      continue;
    }
    Nodes nodes;
    kernels.lattice_values(level, degree, center, patch_half, nodes.values);
    float* polynomial = polynomials + patch * far_floats;
    lattice_polynomial(nodes.values, polynomial);
    float x_most = 0, y_most = 0;
    for (int i = 0; i < lattice_nodes; ++i) {
      x_most = std::max(x_most, nodes.x(i));
      y_most = std::max(y_most, nodes.y(i));
    }
    out.f_error[patch] = level.f_error + lattice.field + rounding * x_most;
    out.g_error[patch] = level.g_error + lattice.gradient + rounding * y_most;
    const Errors bend = bends(polynomial);
    const std::uint64_t bits =
        marked_cells(nodes, iso, {bend.field + 2 * out.f_error[patch], bend.gradient + 2 * out.g_error[patch]});
    if (bits == 0) {
      write_empty(patch, out);
      continue;
    }
    Fit fit(center, polynomial);
    for (std::uint64_t left = bits; left != 0; left &= left - 1) fit.include(__builtin_ctzll(left));
    fit.write(patch, out);
  }
}

}  // namespace marrow
