// The inner loops of tracing: field sums over the sources of one block, and the first root along a ray.
//
// Compiled once for each instruction set (block_kernels_<set>.cpp); all give the same bits, because every
// sum has 16 lanes whatever the hardware, is reduced in one fixed order, and uses only + - * / and sqrt.
//
// Everything is in block coordinates: x = (p - centre) / half. In them f and grad_S f keep their values.
#pragma once

#include <cstdint>
#include <string_view>

#include "field/trace/iso_curve.h"

namespace marrow {

inline constexpr int lanes = 16;
inline constexpr int floats_per_group = 5 * lanes;   ///< x[16] y[16] z[16] weight[16] radius[16]
inline constexpr int far_monomials = 35;             ///< of degree <= 4
inline constexpr int far_floats = far_monomials * 4;  ///< (f, Gx, Gy, Gz) for each monomial

/// One representation of the field in a block: f = sum w d^-m + polynomial, G = grad_S f likewise with w tau.
struct FieldLevel {
  const float* sources = nullptr;  ///< curve groups, then point groups; 64-byte aligned
  int curve_groups = 0;            ///< of exponent m = degree
  int point_groups = 0;            ///< of exponent m = degree - 1
  const float* far = nullptr;      ///< far_floats coefficients
  float f_error = 0, g_error = 0;  ///< added to f and |G| wherever "outside" is to be proved
};

/// What the kernels read of a block. The coarse level, with its certified errors, finds where the surface can be; the
/// fine level is the field that is rendered.
struct BlockView {
  FieldLevel coarse, fine;
  int degree = 4;
  IsoCurve::View iso;
};

struct LocalRay {
  float origin[3];
  float direction[3];  ///< unit length
};

struct Root {
  float t = 0;
  bool hit = false;
  bool certified = true;  ///< false: a gap too short to decide was skipped
  int evaluations = 0;
};

/// Gaps along a ray shorter than this times the distance to the nearest source are not decided.
inline constexpr float shortest_gap = 2e-5F;

struct PointField {
  float f, gradient[3];   ///< of f
  float si_gradient[3];   ///< G
  float hessian[6];       ///< of the potential: derivative of G; xx yy zz xy xz yz
  float nearest;          ///< distance to the nearest source
};

/// 4 x 4 x 4 sub-cells of the block's cube [-1, 1]^3; bit x + 4 y + 16 z is set where the field may reach 1.
inline constexpr int mask_size = 4;

struct BlockKernels {
  /// The first t in [t0, t1] where the corrected field reaches 1; with `any`, any such t.
  Root (*first_root)(const BlockView&, const LocalRay&, float t0, float t1, bool any);
  PointField (*point_field)(const BlockView&, const float point[3]);
  /// V_lower(u) - v at a point: positive only where the field is certainly below 1.
  float (*margin)(const BlockView&, const float point[3]);
  std::uint64_t (*mask)(const BlockView&);
};

/// The kernels of an instruction set ("sse4", "avx2", "avx512"), or of the best one here for "";
/// null when the name is unknown or this machine cannot run it.
const BlockKernels* block_kernels(std::string_view instruction_set);

}  // namespace marrow
