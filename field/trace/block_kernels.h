// The inner loops of tracing: field sums over the sources of one block, and the first root along a ray.
//
// Compiled once for each instruction set (block_kernels_<set>.cpp); all give the same bits, because every
// sum has 16 lanes whatever the hardware, is reduced in one fixed order, and uses only + - * / and sqrt.
//
// Everything is in block coordinates: x = (p - centre) / half. In them f and grad_S f keep their values.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "field/trace/iso_curve.h"

namespace marrow {

inline constexpr int lanes = 16;
inline constexpr int floats_per_group = 5 * lanes;    ///< x[16] y[16] z[16] weight[16] radius[16]
inline constexpr int far_monomials = 35;              ///< of degree <= 4
inline constexpr int far_floats = far_monomials * 4;  ///< (f, Gx, Gy, Gz) for each monomial

/// One representation of the field in a block: f = sum w d^-m + polynomial, G = grad_S f likewise with w tau.
struct FieldLevel {
  const float* sources = nullptr;  ///< curve groups, then point groups; 64-byte aligned
  int curve_groups = 0;            ///< of exponent m = degree
  int point_groups = 0;            ///< of exponent m = degree - 1
  const float* far = nullptr;      ///< far_floats coefficients
  float f_error = 0, g_error = 0;  ///< added to f and |G| wherever "outside" is to be proved
};

/// Boxes in the eight octants of a cube, x the lowest bit, in coordinates of a block or a tile.
struct alignas(32) OctantBoxes {
  float lower[3][8], upper[3][8];
  unsigned present = 0;  ///< a bit for each octant that has a box
};

/// A cube of a block in which surface may be: a polynomial of the whole field with certified errors.
struct Patch {
  enum class Kind { Empty, Smooth, Sources, Divided };
  Kind kind = Kind::Empty;  ///< Sources: no useful polynomial, the coarse level must be asked
  /// Surface is only in this box and where normal . x <= offset, in block coordinates.
  float lower[3], upper[3], normal[3], offset;
  float center[3], half;
  float f_error, g_error;  ///< of the polynomial against the exact field, over the cube
  float polynomial[far_floats];
  const struct Octants* octants = nullptr;  ///< of Divided
};

/// The octants of a block or of a patch; those present are made when the first ray comes.
struct Octants {
  OctantBoxes boxes;
  const Patch& (*patch)(const Octants&, int octant);
};

/// What the kernels read of a block. The patches, and where they fail the coarse level, find where the surface can be;
/// the fine level is the field that is rendered.
struct BlockView {
  const Octants* octants = nullptr;
  FieldLevel coarse;
  const FieldLevel& (*make_fine)(const void* owner) = nullptr;  ///< made when it is first needed
  const void* owner = nullptr;
  int degree = 4;
  IsoCurve::View iso;

  const FieldLevel& fine() const { return make_fine(owner); }
};

struct LocalRay {
  float origin[3];
  float direction[3];  ///< unit length
};

struct Root {
  float t = 0;
  bool hit = false;
  float undecided = std::numeric_limits<float>::infinity();  ///< where the first gap too short to decide was skipped
  int evaluations = 0;
  bool enters_inside = false;  ///< a hit at t0, because the field is clearly above 1 there
};

/// Gaps along a ray shorter than this times the distance to the nearest source are not decided.
inline constexpr float shortest_gap = 2e-5F;

struct PointField {
  float f, gradient[3];  ///< of f
  float si_gradient[3];  ///< G
  float hessian[6];      ///< of the potential: derivative of G; xx yy zz xy xz yz
  float nearest;         ///< distance to the nearest source
  float second, third;   ///< M2 and m M3 of tracing.md 3.1, for bounds of f and G nearby
};

inline constexpr int far_moment_count = 80;  ///< see FarMoments

inline constexpr int floats_per_piece_group = 13 * lanes;
///< from xyz, along xyz, 1 / length^2 (0 for a point), share = mass / tau^m, radius at the end less that at `from`,
///< tau (the larger), length, reach, least radius of a group's pieces. Sources are within `reach` of the segment,
///< within `length` of its nearest point. Unused lanes have share 0.

/// Bounds over the ball around one octant of a cube, in the cube's coordinates.
struct OctantBounds {
  float f_high = 0, gradient_high = 0;  ///< when nothing touches
  float f_low = 0;
  float weight = 0, weighted_radius = 0;  ///< fields of the pieces at the centre, and the same times their radii
  bool touches = false;                   ///< a piece comes into the ball
  float thinness = 0;                     ///< 1 / radius of the thinnest piece within four of its radii of the ball
};

/// The error of a lattice's polynomial for one source at the distance d from the centre of a cube, both over its half
/// side: at most field * (d^2 - offset)^-((m+5)/2) in f and gradient * tau * (d^2 - offset)^-((m+6)/2) in |G|, from
/// d^2 = nearest on. See lattice.h.
struct LatticeError {
  static constexpr float nearest = 9, offset = 2.6F;
  float field, gradient;
};

/// Of a field over a cube.
struct CubeBounds {
  float f_high = 0, g_high = 0, f_low = 0;  ///< the upper ones when nothing touches
  bool touches = false;                     ///< a source comes into the ball around the cube
  float f_error = 0, g_error = 0;           ///< of the polynomial through its lattice
};

inline constexpr int lattice_stride = 128;  ///< nodes of a lattice in whole vectors

/// How far the field can be above the values at all eight corners of a cell of the lattice, and below them.
struct LatticeRaise {
  float field, gradient;
  float surely_inside;  ///< from this f on all is inside
};

/// The stretches of a ray in boxes, nearest first.
struct Stretches {
  alignas(32) float begin[8], end[8];  ///< by octant
  int count;
  int order[8];  ///< octants that the ray meets
};

/// Pieces of one kind against the ball around a cube.
struct FarQuery {
  float center[3];
  float radius, half;  ///< of the ball and of the cube, in the coordinates of the pieces
  int exponent;
  bool points;
  float field_budget, gradient_budget;              ///< the errors that one piece may cause
  float field_series, gradient_series;              ///< binom(exponent + 4, 5), binom(exponent + 5, 5)
  float field_rule[4] = {}, gradient_rule[4] = {};  ///< constants of GaussError for 1, 2 and 3 nodes
};

/// Sums over the pieces that are far: their errors, their field and |G| at the cube's centre at most, their moments.
struct FarSums {
  float f_error, g_error, field, gradient;
  float f[far_moment_count],
      potential[far_moment_count];  ///< in units of the cube, without the constants of FarMoments
};

struct BlockKernels {
  struct Query {
    float t0, t1;
    bool any;              ///< any root will do
    bool from_surface;     ///< the ray begins at t0, perhaps beside the surface
    bool leaving = false;  ///< the ray is inside at t0, and what is asked for is where it leaves
  };
  /// The first t in [t0, t1] where the corrected field reaches 1.
  Root (*first_root)(const BlockView&, const LocalRay&, const Query&);
  PointField (*point_field)(const FieldLevel&, int degree, const float point[3]);
  void (*stretches)(const OctantBoxes&, const LocalRay&, float t0, float t1, Stretches&);
  /// `errors`: of curves, and of points.
  CubeBounds (*cube_bounds)(const FieldLevel&, int degree, const LatticeError errors[2], const float center[3],
                            float half);
  /// (f, Gx, Gy, Gz) at the nodes of the lattice (lattice.h) of a cube; room for lattice_stride nodes.
  void (*lattice_values)(const FieldLevel&, int degree, const float center[3], float half, float* values);
  /// Bit i + 4 j + 16 k for each cell of the lattice that may hold surface, from the values at its nodes.
  std::uint64_t (*lattice_marks)(const IsoCurve::View&, const LatticeRaise&, const float* values);
  /// Moments of groups of inverted sources (y, field at the origin, tau), without the constants of FarMoments.
  void (*far_moments)(const float* groups, int count, float* f, float* potential);
  /// Sets a bit of near[k] for each lane of group k that is not far.
  void (*far_split)(const float* pieces, int groups, const FarQuery&, unsigned short* near, FarSums&);
  /// Of the eight octants, from groups of pieces: curves, then points.
  void (*octant_bounds)(const float* pieces, int curve_groups, int point_groups, int degree, OctantBounds*);
};

/// The kernels of an instruction set ("sse4", "avx2", "avx512"), or of the best one here for "";
/// null when the name is unknown or this machine cannot run it.
const BlockKernels* block_kernels(std::string_view instruction_set);

}  // namespace marrow
