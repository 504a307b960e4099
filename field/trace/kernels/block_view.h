// What the kernels read of one block: the two levels of its field, and where in it surface can be.
//
// In block coordinates, x = (p - centre) / half; in them f and grad_S f keep their values.
#pragma once

#include <cstdint>

#include "field/trace/curve/iso_curve.h"
#include "field/trace/kernels/share_part.h"

namespace marrow {

inline constexpr int lanes = 16;
inline constexpr int floats_per_group = 5 * lanes;  ///< x[16] y[16] z[16] share[16] radius[16]
inline constexpr float unused_place = 1e3F;  ///< x, y and z of lanes without a source, which have share and radius 0

/// Of a symmetric tensor of degree 8, x^i y^j z^(8-i-j), j faster: binom(8 + 2, 2).
inline constexpr int tensor_components = (8 + 2) * (8 + 1) / 2;
/// What a tensor sum f u^8 over strands goes with, behind its components: sums of f, f^2, and f^2 of those that have a
/// direction.
enum TensorSum { sum_of_f = tensor_components, sum_of_squares, sum_of_directed_squares };
inline constexpr int tensor_floats = sum_of_directed_squares + 1;
static_assert(tensor_floats % lanes == 0);  // kernels go through them in whole registers
/// What stands there in StrandLevel::far: sum f, and over pairs, each counted twice, f_i f_j (u_i . u_j)^8 and f_i f_j.
enum FarSum { far_sum = tensor_components, far_turned_pairs, far_pairs };
static_assert(static_cast<int>(far_pairs) < tensor_floats);
inline constexpr int most_strands = 512;        ///< that a block lists
inline constexpr int quadratic_monomials = 10;  ///< 1 x y z xx yy zz xy xz yz

/// What directions make of a pair of strands, as shares of the range of angles: crossing / 2 of both where they cross,
/// and added / 2 of both more where they are parallel.   [Zanni et al. 2015, eq. 16: B and A]
struct StrandAngle {
  float crossing = 0, added = 1;
};

/// The strands of a fine level, whose directions give the angle (strands.h).
struct StrandLevel {
  const float* directions = nullptr;  ///< of each source of the curve groups: x[16] y[16] z[16]
  const int* groups = nullptr;        ///< curve groups of each strand, which follow each other
  const float* rest = nullptr;  ///< for each strand and monomial (f, sum f_s u_s) of its pieces that are not listed
  int count = 0;
  /// Strands that are not listed, for each monomial tensor_floats: sum f u^8; then far_sum, far_turned_pairs and
  /// far_pairs.
  const float* far = nullptr;
  /// Where strands have angles of their own, of each strand, and `crossing` of each source of the point groups; else
  /// null, and all have those of StrandAngle.
  const StrandAngle* angles = nullptr;
  const float* point_crossing = nullptr;
  /// Then for each monomial tensor_floats more: sum added f u^8, and sum crossing f in place of far_sum. The pairs of
  /// `far` are weighted by what directions make of them.
  const float* far_weighted = nullptr;
};

/// One representation of the field in a block: f = sum w d^-m + polynomial, G = grad_S f likewise with w tau. Sources
/// hold their radius tau and share = w / tau^m, which is of the size of 1.
struct FieldLevel {
  const float* sources = nullptr;        ///< curve groups, then point groups; 64-byte aligned
  int curve_groups = 0;                  ///< of exponent m = degree
  int point_groups = 0;                  ///< of exponent m = degree - 1
  int far_degree = 4;                    ///< of the polynomials: one of evaluated_degrees
  const float* far = nullptr;            ///< (f, Gx, Gy, Gz) for each monomial
  float f_error = 0, g_error = 0;        ///< added to f and |G| wherever "outside" is to be proved
  float far_slope = 0, far_g_slope = 0;  ///< |derivative| of the far f and G along any line, at most
  float far_bend = 0, far_g_bend = 0;    ///< the same of |second derivative| / 2
  const FieldLevel* angle = nullptr;     ///< the field A of angle_field.h, with its f_error
  const StrandLevel* strands = nullptr;  ///< of the level that patches are made from: the strands, whose near sources
                                         ///< are those of the level, in their order
};

inline constexpr int slots_of_block = 512;
/// In place of the eighths of a slot that nobody has asked for yet. Where only the first one may hold surface, the
/// second one is said to, too.
inline constexpr unsigned unknown_eighths = 1;

/// What the kernels read of a block. The coarse level finds where the surface can be; the fine level is the field that
/// is rendered.
struct BlockView {
  /// For an octant of the block (x the lowest bit) a bit for each of its 4 x 4 x 4 slots, x + 4 y + 16 z, that may hold
  /// surface.
  std::uint64_t (*find_surface)(const void* owner, int octant) = nullptr;
  /// The same of all octants of which it is known by now, a bit for each of these; 0 of the others.
  unsigned (*find_known_surface)(const void* owner, std::uint64_t (&octants)[8]) = nullptr;
  bool tells_eighths = false;  ///< of slots that may hold surface; the same for all blocks of a blend
  /// Of each slot, 64 octant + slot, a bit for each of its eighths (x the lowest) that may hold surface, or
  /// unknown_eighths until find_eighths is asked; 64-byte aligned. Null where nothing is told, or no slot may.
  const unsigned char* eighths = nullptr;
  unsigned (*find_eighths)(const void* owner, int slot) = nullptr;
  /// Made when they are needed; one that is not kept is good until the same is asked of another block.
  const FieldLevel& (*make_coarse)(const void* owner) = nullptr;
  const FieldLevel& (*make_fine)(const void* owner) = nullptr;
  /// The level if it is kept; else null.
  const FieldLevel* (*kept_level)(const void* owner, bool fine) = nullptr;
  /// Asks memory for the first lines of what is kept of a level, or for the rest, when these have come.
  void (*ask_for_level)(const void* owner, bool fine, bool rest) = nullptr;
  const void* owner = nullptr;
  int degree = 4;
  IsoCurve::View iso;
  AngleTables tables;  ///< where alpha varies
  /// Where directions give alpha, else null: the octants of the block, and what makes that of a path.
  const SharePart* parts = nullptr;
  const SharePart& (*make_part)(const void* owner, int path) = nullptr;

  std::uint64_t surface(int octant) const { return find_surface(owner, octant); }
  unsigned known_surface(std::uint64_t (&octants)[8]) const { return find_known_surface(owner, octants); }
  int eighths_of(int slot) const {
    const unsigned char known = __atomic_load_n(eighths + slot, __ATOMIC_RELAXED);
    return static_cast<int>(known != unknown_eighths ? known : find_eighths(owner, slot));
  }
  const FieldLevel& coarse() const { return make_coarse(owner); }
  const FieldLevel& fine() const { return make_fine(owner); }
};

}  // namespace marrow
