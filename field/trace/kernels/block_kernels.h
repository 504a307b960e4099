// The inner loops of tracing: field sums over the sources of one block, and the first root along a ray.
//
// Compiled once for each instruction set (block_kernels_<set>.cpp); all give the same bits, because every
// sum has 16 lanes whatever the hardware, is reduced in one fixed order, and uses only + - * / and sqrt. Packets have a
// ray in each lane of a register, 16, 8 or 4: their bits do not depend on how many go together.
//
// Everything is in block coordinates: x = (p - centre) / half. In them f and grad_S f keep their values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "field/blend/angle/least_direction.h"
#include "field/math/lane_set.h"
#include "field/trace/kernels/block_view.h"
#include "field/trace/kernels/cube_remainder.h"
#include "field/trace/kernels/field_around.h"
#include "field/trace/kernels/strand_tensor.h"

namespace marrow {

/// A part of a curve, tapered linearly, for which the rule of so many nodes stands. Node i of the rule, at s of the
/// part with weight w, is a source of radius tau = radius + taper s and share w unit / tau.
struct CurvePiece {
  float from[3], along[3];
  float radius, taper;
  float unit;  ///< its length over N of the kernel
  int nodes;   ///< 1 to most_rule_nodes
};

inline constexpr int most_rule_nodes = 16;
/// Gauss-Legendre rules by their number of nodes, positions in (0, 1), weights that add up to 1, and zeros behind them
/// up to sixteen; each twice, one behind the other.
struct NodeTable {
  alignas(64) float positions[most_rule_nodes + 1][2 * lanes], weights[most_rule_nodes + 1][2 * lanes];
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
  float searched_from = 0;      ///< where the ray first comes to where surface can be, if there are evaluations
  bool begins_outside = false;  ///< the ray is known to be outside before the hit, or to have been before t0
  bool enters_inside = false;   ///< a hit, but the field is clearly above 1 where surface can first be in the block
};

/// Rays side by side in double, 64-byte aligned: the arrays of a RayPacket.
struct PacketView {
  const double *origin[3], *direction[3], *t_min, *t_max;
  const FieldAround* const* around;
};

/// Layers of slots of a tile: where a cell or a smaller tile is in it.
struct TileLayers {
  double center[3], half;              ///< of the tile
  float first_plane[3], end_plane[3];  ///< in its coordinates
};

/// What the search of a packet needs beside the stack, which may be small: one for each thread.
struct PacketMemory {
  // What is in them is known to the kernels alone, which check that it fits: a stack of islands of each lane, and some
  // hundred and fifty floats a ray, most of them for runs whose angle goes by patches.
  static constexpr std::size_t of_search = 96 << 10, of_rays = packet_size * 640;
  alignas(64) unsigned char search[of_search];
  alignas(64) unsigned char rays[of_rays];
};

/// Where a cell is: rays are clipped to the box around all that the tile of the first level holds, then to the layers
/// of each smaller tile that holds the cell, then to those of the cell.
struct CellPlace {
  static constexpr int most_tiles = 24;  ///< a tile takes two of at most 40 halvings
  double box_lower[3], box_upper[3];
  TileLayers tiles[most_tiles];
  int tile_count;
};

/// The rays of a packet that are in one cell, and its block. Cells of a packet are of one blend, and no ray is in two.
struct CellRays {
  const BlockView* block;
  double center[3], half;  ///< of the block, in the coordinates of the rays
  LaneSet rays;
};

/// Of each ray of a packet in its cell.
struct CellRoots {
  alignas(64) double outside_from[packet_size];  ///< as in CellLog; in and out
  alignas(64) double enter[packet_size];         ///< where it comes into the cell, and leaves it
  alignas(64) double exit[packet_size];
  alignas(64) double t[packet_size];              ///< of a hit
  alignas(64) double undecided[packet_size];      ///< as in Root
  alignas(64) double searched_from[packet_size];  ///< the same
  alignas(64) int evaluations[packet_size];
  LaneSet entered, begins_outside, enters_inside;
  LaneSet met, hit;  ///< met the surface; and not behind their ends
};

/// Gaps along a ray shorter than this times the distance to the nearest source are not decided: with an inside place
/// behind it, such a gap is the root as well as it is known.
inline constexpr float shortest_gap = 2e-5F;

/// What belongs to a crossing, in the same unit: a stretch that was not decided and ends this near to the root is the
/// root as well as it is known. One gap, and one for where the root in it may be told.
inline constexpr float crossing_gap = 2 * shortest_gap;

/// The same of gaps that end at a certified stretch or with the run. Beside a root certificates are as short as
/// shortest_gap, so that two of them leave gaps of that size which more samples close; an eighth is three halvings.
inline constexpr float shortest_gap_between = shortest_gap / 8;

/// In half sides: any root, as told by a place inside, this near to the end of the ray is given as that end, for the
/// first root may lie before it or behind. Roots are off by shortest_gap times a distance of some diagonals, and ends
/// as floats by less.
inline constexpr double nearly_ended = 0x1p-12;

/// In the coordinates of a block.
struct PlacesInLanes {
  alignas(64) float at[3][lanes] = {};
};

/// Hits on the surface of one blend, a lane each, as PointField tells of them in the coordinates of their blocks; and
/// where rays may leave from beside them.
struct SurfaceLanes {
  alignas(64) float f[lanes], gradient[3][lanes], si_gradient[3][lanes], hessian[6][lanes];
  alignas(64) float nearest[lanes], second[lanes], third[lanes];
  alignas(64) float f_error[lanes], g_error[lanes];  ///< of their levels
  /// Of the range of angles, where alpha varies: the share, its gradient and bend, by how much it may be off on a step,
  /// and what makes a step of h distances change it by up to 1 / (1 - growth h) times that.
  alignas(64) float share[lanes], share_gradient[3][lanes], share_bend[lanes], share_error[lanes], share_growth[lanes];

  alignas(64) float growth[3][lanes];  ///< out: the direction in which the corrected field grows, of any length
  alignas(64) float step[lanes];       ///< out: how far to go against it until the field is certainly below 1
  alignas(64) float margin[lanes];     ///< out: positive where that is proved
};

/// Steps away from a surface, over the distance to the nearest source: from the first on, each twice the one before,
/// below the second.
inline constexpr float shortest_start = 8e-6F, longest_start = 0.1F;

/// What tells where the surface of a blend is.
struct SurfaceRule {
  IsoCurve::View iso;
  AngleTables tables;  ///< where alpha varies
  int degree;
};

/// The share of the range of angles as the strands of a fine level tell it, at strand_place of a cube; lanes behind
/// them hold nothing.
struct StrandShares {
  alignas(64) float share[lanes];
  alignas(64) float slope[3][lanes];  ///< its derivatives by x, y, z
};
inline constexpr int floats_per_strand = 19 * lanes;  ///< of the memory that it takes

inline constexpr int most_far_moments = 224;  ///< monomials to degree 9 (far_field.h), in eights
inline constexpr int most_far_nodes = 5;

inline constexpr int floats_per_piece_group = 14 * lanes;
///< from xyz, along xyz, 1 / length^2 (0 for a point), share = mass / tau^m, radius at the end less that at `from`,
///< tau (the larger), length, reach, least radius of a group's pieces, Piece::lean (for far_split() alone; all others
///< want pieces that do not lean). Sources are within `reach` of the segment, within `length` of its nearest point.
///< Unused lanes have share 0.

/// Bounds over the ball around one octant of a cube, in the cube's coordinates.
struct OctantBounds {
  float f_high = 0, gradient_high = 0;  ///< when nothing touches
  float f_low = 0;
  float weight = 0, weighted_radius = 0;  ///< fields of the pieces at the centre, and the same times their radii
  bool touches = false;                   ///< a piece comes into the ball
  float thinness = 0;                     ///< 1 / radius of the thinnest piece within four of its radii of the ball
};

/// Of a field over a cube.
struct CubeBounds {
  float f_high = 0, g_high = 0, f_low = 0;  ///< the upper ones when nothing touches
  bool touches = false;                     ///< a source comes into the ball around the cube
};

/// The stretches of a ray in the slots of a cube, nearest first. They follow each other without gaps where slots do.
struct Walk {
  static constexpr int most = 10;  ///< a line crosses three planes within the cube along each axis
  float begin[most], end[most];
  int slot[most];
  int count;
};

/// Pieces of one kind against the ball around a cube.
struct FarQuery {
  float center[3];
  float radius, half;  ///< of the ball and of the cube, in the coordinates of the pieces
  int exponent;
  bool points;
  bool some_lean;                       ///< else Piece::lean is 0 for all
  float field_budget, gradient_budget;  ///< the errors that one piece may cause
  int far_degree;                       ///< P of far_field.h
  int most_nodes;                       ///< of a far piece
  float field_series, gradient_series;  ///< binom(exponent + P, P + 1), binom(exponent + P + 1, P + 1)
  float field_rule[most_far_nodes + 1] = {}, gradient_rule[most_far_nodes + 1] = {};  ///< constants of GaussError
  /// What a near piece may add anywhere in the ball to be left out, and count as an error; 0: none is left out.
  float slight_field = 0, slight_gradient = 0;
};

/// Sums over the pieces that are far: their errors, their field and |G| at the cube's centre at most, their moments.
struct FarSums {
  float f_error, g_error, field, gradient;
  float f[most_far_moments], potential[most_far_moments];  ///< as far_moments() finds them, in units of the cube
};

/// xyz, weight, direction xyz of nodes, two for each piece, in lanes that follow each other; of their pieces the
/// length, and the difference of the radii at its ends over the larger one.
inline constexpr int floats_per_strand_group = 9 * lanes;

/// Where a quadratic is fitted in a cube: its centre, near its faces, near its corners.
inline constexpr int strand_places = 15;
inline constexpr float strand_place[strand_places][3] = {{0, 0, 0},
                                                         {0.9F, 0, 0},
                                                         {-0.9F, 0, 0},
                                                         {0, 0.9F, 0},
                                                         {0, -0.9F, 0},
                                                         {0, 0, 0.9F},
                                                         {0, 0, -0.9F},
                                                         {0.8F, 0.8F, 0.8F},
                                                         {-0.8F, 0.8F, 0.8F},
                                                         {0.8F, -0.8F, 0.8F},
                                                         {-0.8F, -0.8F, 0.8F},
                                                         {0.8F, 0.8F, -0.8F},
                                                         {-0.8F, 0.8F, -0.8F},
                                                         {0.8F, -0.8F, -0.8F},
                                                         {-0.8F, -0.8F, -0.8F}};

/// One strand as a cube sees it; lengths in any one unit, places from any one origin.
struct StrandQuery {
  const float* groups;
  int count, exponent;
  float center[3], half;
  float largest_ratio;  ///< of the radius of the cube to the distance of what is far
  /// Room for a bit for each lane of each group: of the nodes of pieces that are not far, or that a quadratic or their
  /// two nodes would not tell to within `allowed` in f. They do not count. Null: all do.
  unsigned short* near;
  float allowed;
};
struct StrandInMiddle {
  float field;
  float error;  ///< of f as a quadratic, an estimate: of the nodes that count
  float ratio;  ///< the largest radius of the cube over the distance of a node that counts
};
struct StrandSamples {
  float sums[strand_places][4];  ///< f and sum f_s u_s
};
/// What a strand counts in a tensor and in the sums beside it: those of f u^8 and of f^2 with a direction `directed`
/// times, of f and of f^2 `all` times.
struct TensorWeights {
  float directed = 1, all = 1;
};

struct BlockKernels {
  struct Query {
    float t0, t1;
    bool any;                             ///< any root will do
    bool from_surface;                    ///< the ray begins at t0, perhaps beside the surface
    bool from_outside = false;            ///< the ray is known to have been outside before t0
    bool leaving = false;                 ///< the ray is inside at t0, and what is asked for is where it leaves
    const FieldAround* around = nullptr;  ///< Ray's
  };
  /// The first t in [t0, t1] where the corrected field reaches 1.
  Root (*first_root)(const BlockView&, const LocalRay&, const Query&);
  /// Where rays are in a cell, if they come into it: their `enter` and `exit`. Returns those that do.
  LaneSet (*enter_cell)(const CellPlace&, const PacketView&, const LaneSet& asked, bool any, CellRoots&);
  /// first_root() for each ray in its cell, from `enter` to `exit`, where skeletons have no angle each, to the same
  /// bits.
  void (*roots_between)(const CellRays* cells, int count, const PacketView&, bool any, PacketMemory&, CellRoots&);
  /// At the first `count` places, which share a level.
  void (*point_fields)(const FieldLevel&, int degree, const PlacesInLanes&, int count, PointField*);
  /// Finds `growth`, `step` and its `margin` of the first `count` lanes (by taylor_remainder.h).
  void (*surface_starts)(const SurfaceRule&, int count, SurfaceLanes&);
  /// Finds `margin` of the first `count` lanes, which are places anywhere: positive where the field is below 1.
  void (*place_margins)(const SurfaceRule&, int count, SurfaceLanes&);
  /// Through the slots of a set, in coordinates of the cube of 4 x 4 x 4 slots, [-1, 1]^3.
  void (*walk)(std::uint64_t slots, const LocalRay&, float t0, float t1, Walk&);
  /// Writes the sources of curves, group after group; unused lanes of the last one as SourceGroups leaves them.
  void (*write_nodes)(const CurvePiece*, int count, const NodeTable&, float* groups);
  CubeBounds (*cube_bounds)(const FieldLevel&, int degree, const float center[3], float half);
  /// Of the eight octants of a cube (x the lowest bit), each `margin` larger than it is. Not as close as cube_bounds():
  /// what is far from the whole cube is bounded there.
  void (*octant_cube_bounds)(const FieldLevel&, int degree, const float center[3], float half, float margin,
                             CubeBounds (&octants)[8]);
  /// Moments of groups of inverted sources (y, field at the origin, tau): sums of the field times the monomials of y to
  /// the far degree, in the order of far_field.h, and of the field times tau times those to a degree more.
  void (*far_moments)(const float* groups, int count, int far_degree, float* f, float* potential);
  /// Sets a bit of near[k] for each lane of group k that is not far.
  void (*far_split)(const float* pieces, int groups, const FarQuery&, unsigned short* near, FarSums&);
  /// Of the eight octants, from groups of pieces: curves, then points.
  void (*octant_bounds)(const float* pieces, int curve_groups, int point_groups, int degree, OctantBounds*);
  /// `memory`: floats_per_strand for each strand, 64-byte aligned.
  void (*strand_shares)(const FieldLevel&, int degree, const float (&center)[3], float half, float* memory,
                        StrandShares&);
  void (*strand_in_middle)(const StrandQuery&, StrandInMiddle&);
  /// With `near`: as strand_in_middle() found them.
  void (*strand_samples)(const StrandQuery&, StrandSamples&);
  /// Adds a strand to tensor_floats sums at each of strand_place, not where its f is infinite.
  void (*add_strand)(const StrandSamples&, const TensorWeights&, float* tensors);
};

/// The kernels of an instruction set ("sse4", "avx2", "avx512"), or of the best one here for "";
/// null when the name is unknown or this machine cannot run it.
const BlockKernels* block_kernels(std::string_view instruction_set);

}  // namespace marrow
