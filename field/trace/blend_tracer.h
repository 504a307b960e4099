// Certified ray tracing of one blend [Zanni, Cani and Gleicher 2015], in the blend's own coordinates.
//
// The blend's space is divided into tiles once; a tile is divided into cells, and what a cell needs is built, when the
// first ray enters it, and kept. All of it is a function of the place alone, so pictures do not depend on the order of
// rays or on threads.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "field/blend/blend_field.h"
#include "field/math/box3.h"
#include "field/math/ray.h"
#include "field/math/ray_packet.h"
#include "field/math/side.h"
#include "field/trace/cells/cell_settings.h"
#include "field/trace/kernels/field_around.h"
#include "field/trace/ray_visit.h"

namespace marrow {

class Block;
class Tile;
struct CellStep;
struct SurfaceRule;

struct TraceOptions {
  std::string instruction_set;  ///< "sse4", "avx2", "avx512"; empty: the best of this machine
  /// Aim for the displacement of the traced surface from the exact one, over the local radius. Error budgets come from
  /// it; TraceStatistics::largest_error tells what is certified.
  double tolerance = 1e-5;
  /// From so much memory of blocks in the process on, levels of blocks are not kept as kernels read them; empty: by the
  /// number of pieces (precision.h). What is made of them again has the same bits.
  std::optional<std::size_t> kept_bytes{};
  /// Up to so much in all (2 GiB) they are kept as what they are made of (compact_level.h), behind that not at all. A
  /// million segments seen from afar have half a million blocks that few rays meet.
  std::size_t compact_bytes = std::size_t{1} << 31;
  /// Empty: by the number of primitives.
  std::optional<CellTreeSettings> cells{};
  /// The degree to which far sources of the two levels are gathered, 4, 6 or 8; empty: by the number of pieces.
  std::optional<int> coarse_far_degree{}, fine_far_degree{};
  /// Whether slots of blocks tell which of their eighths may hold surface; empty: by the number of pieces and samples.
  std::optional<bool> eighths{};
  /// As in CellTreeSettings.
  std::shared_ptr<const RaySpacing> spacing{};
};

struct CellHit {
  double t = 0;
  const Block* block = nullptr;  ///< that it was found in
};

/// A part of a blend's space, as far as it is divided by now: a tile, a smaller tile in it, or a cell.
struct TracePart {
  std::size_t tile = 0;          ///< of the first level
  const Tile* within = nullptr;  ///< the tile whose slot it is; null for a whole tile of the first level
  int slot = 0;
  Box3 box{};  ///< around all of the part that a ray has to be traced in
};

/// What a ray did in a tile or a part, hit or not.
struct CellLog {
  double enter = 0;                                            ///< t at which the ray came into it
  double undecided = std::numeric_limits<double>::infinity();  ///< t of the first gap too short to decide
  std::uint32_t evaluations = 0;                               ///< of all visits
  Side side = Side::Unknown;                                   ///< where the ray was before what it meets next
  /// For parts, which pass it on: a ray has been outside before it enters what lies from here on, which saves asking.
  double outside_from = std::numeric_limits<double>::infinity();
  std::vector<RayVisit>* visits = nullptr;  ///< grows by the cells with evaluations, if there is one

  void add(const RayVisit& visit) {
    evaluations += visit.evaluations;
    if (visits != nullptr && visit.evaluations > 0) visits->push_back(visit);
  }
};

/// Which crossings of a ray count.
struct CrossingFilter {
  /// Whether all in a cell do, or none, so that it need not be searched; nothing: not all or not known.
  std::function<std::optional<bool>(const Box3& cell)> counts_in;
  std::function<bool(double t)> counts_at;
};

/// Rays of a packet that come to one part.
struct PartRays {
  TracePart part;
  LaneSet rays;
};

/// What the rays of a packet met in their parts, lane by lane; `hit.block` is null where nothing was met.
struct CellHits {
  std::array<CellHit, RayPacket::size> hit{};
  std::array<CellLog, RayPacket::size> log{};
};

struct SurfacePoint {
  UnitVec3 normal;     ///< outward, from the closed-form gradient of the corrected field
  Vec3d outside;       ///< beside the surface, where the field is certainly below the iso-value
  FieldAround around;  ///< of the hit, for rays that leave; nothing where each skeleton has an angle
};

/// A hit in a block.
struct SurfaceQuery {
  const Block* block = nullptr;
  Vec3d position;
};

/// Of what has been built so far.
struct TraceStatistics {
  std::size_t tiles = 0;  ///< of the first level, divided or not
  std::size_t cells = 0, blocks = 0, sources = 0, bytes = 0;
  double largest_error = 0;  ///< of any block so far: certified bound of the corrected field's error
};

/// Safe to use from many threads.
class BlendTracer {
 public:
  /// Why a blend cannot be traced; empty: it can.
  static std::string refusal(const BlendField&);
  /// Errors: an unknown instruction set, or a refusal.
  static Result<std::unique_ptr<BlendTracer>> make(BlendField, const TraceOptions&);
  ~BlendTracer();

  /// Tiles are disjoint, and all surface lies in them.
  std::size_t tile_count() const;
  Box3 tile_box(std::size_t tile) const;
  /// Of all tiles, and so of all that is inside.
  const Box3& bounds() const;

  /// The first place inside a tile where the ray comes to the surface: from outside, or, for a ray that begins inside,
  /// where it leaves. A ray that begins within rounding of the surface counts as outside. t in [ray.t_min, ray.t_max];
  /// t does not depend on ray.t_max. With `any`, any root, or what is inside already; a ray from outside has one where
  /// it has a first hit.
  std::optional<CellHit> first_hit(std::size_t tile, const Ray&, bool any, CellLog&) const;
  /// What tiles have been divided into so far, less what is known to hold no surface. Answers stay good.
  std::vector<TracePart> parts() const;
  /// The first hit of first_hit() in a tile is the nearest one of its parts, to the same bits; except that a ray is not
  /// followed from part to part: when it turns out to begin inside, `log.side` says so, and its tiles have to be asked.
  std::optional<CellHit> first_hit(const TracePart&, const Ray&, bool any, CellLog&) const;
  /// The whole cell that a part is, whatever of it may hold surface; nothing where it is more than one.
  static std::optional<Box3> cell_box(const TracePart&);
  /// Whether rays are traced sooner together than one by one.
  bool traces_packets() const;
  /// The same for rays of a packet, each in its part, to the same bits. No ray is in two parts.
  void first_hits(std::span<const PartRays>, const RayPacket&, bool any, CellHits&) const;
  /// first_hit() in a tile, for the rays of a set.
  void first_hits(std::size_t tile, const RayPacket&, const LaneSet& rays, bool any, CellHits&) const;
  /// The first crossing of the surface in a part, from either side, that counts. Each cell is searched by itself, from
  /// the side on which the ray comes into it; what it meets inside the part, before the cell, does not tell that side.
  /// Crossings that follow one that does not count by less than the shortest gap (kernels/block_kernels.h) are passed
  /// with it.
  std::optional<CellHit> first_crossing(const TracePart&, const Ray&, const CrossingFilter&, CellLog&) const;
  /// Normal and starting point at a hit in this tile.
  SurfacePoint surface_at(std::size_t tile, const Vec3d& position) const;
  /// The same in the block of a hit.
  SurfacePoint surface_at(const Block&, const Vec3d& position) const;
  /// Of each of the hits, to the same bits; sooner for many.
  void surfaces_at(std::span<const SurfaceQuery> hits, std::span<SurfacePoint> found) const;

  /// What is undecided no farther than this before a hit is the hit itself, as finely as roots are told apart: two of
  /// the shortest gaps at the distance of the nearest skeleton. Asks all skeletons.
  double crossing_length(const Vec3d& position) const;

  /// From a hit against its normal: a place where the field is certainly above 1, if one is found nearby.
  std::optional<Vec3d> inside_beside(const SurfaceQuery& hit, const UnitVec3& normal) const;

  const BlendField& field() const;
  /// Of strongest_material() of the blend, by a few of its sources; invalid: the object's own.
  MaterialId material_at(const Vec3d&) const;
  /// Where the corrected field is clearly above or below 1 (SideBound). For large blends much sooner than the field.
  Side clear_side(const Vec3d& p) const;
  Side clear_side(const Box3&) const;
  /// Whether a ray begins beside a hit of this tracer, outside, as what it knows of the field around tells.
  bool leaves_surface(const Ray&) const;
  TraceStatistics statistics() const;

 private:
  struct State;
  explicit BlendTracer(std::unique_ptr<State>);
  bool is_inside(const Vec3d&) const;
  std::optional<CellHit> crossing_in(const Tile&, int slot, const Ray&, double enter, double exit,
                                     const CrossingFilter&, CellLog&) const;
  std::optional<CellHit> hit_in(const Tile&, const Ray&, bool any, double enter, double exit, CellLog&) const;
  std::optional<CellHit> hit_in(const Tile&, int slot, const Ray&, bool any, double enter, double exit, CellLog&) const;
  struct Stretch;
  std::optional<Stretch> stretch_in(const Tile&, const Ray&, bool any) const;
  std::optional<Stretch> stretch_in(const Tile&, int slot, const Ray&, bool any) const;
  std::optional<Stretch> enter(const TracePart&, const Ray&, bool any, CellLog&) const;
  LaneSet hits_in(const std::array<CellStep, RayPacket::size>&, const LaneSet& rays, const RayPacket&, bool any,
                  CellHits&) const;
  class CellGroup;
  const Block* block_for_packets(const TracePart&) const;
  std::optional<double> step_by_places(const SurfaceRule&, const SurfaceQuery& hit, const UnitVec3& normal,
                                       float nearest) const;
  void add_parts(std::size_t tile, const Tile& within, std::vector<TracePart>&) const;
  const Block& block(const Tile&, int slot) const;
  const Block* block_to_search(const Tile&, int slot) const;
  std::unique_ptr<State> state_;
};

}  // namespace marrow
