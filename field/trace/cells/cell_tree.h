// Space divided into cubes that may hold surface of one blend.
//
// From the region of influence down, cubes are halved, and dropped when bounds of f and |grad_S f| prove the corrected
// field below 1 (or above 1) all over them. This goes at once down to tiles of some cells each; a tile is divided into
// cells, of about the local radius, when somebody asks for it, and cells ask for the sources around them in their turn.
// What a tile or a cell holds is a function of its place alone, so that nothing depends on who asks first.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "field/trace/cells/cell_settings.h"
#include "field/trace/cells/divider.h"
#include "field/trace/cells/tile.h"
#include "field/trace/cells/upper_cubes.h"

namespace marrow {

/// Safe to use from many threads. Refers to what it is made of.
class CellTree {
 public:
  /// A cube to be traced. Its planes are exactly those of its neighbours.
  struct Cell {
    Vec3d center;
    double half;
    const Tile* tile;
    int slot;
    bool large;  ///< a whole octant of its tile

    Box3 box() const {
      const Vec3d h{half, half, half};
      return {center - h, center + h};
    }
  };

  /// `coarse` divides, `fine` is what cells are traced with.
  CellTree(const SourceTree&, const NearFar& coarse, const NearFar& fine, const IsoCurve&, const BlockKernels&,
           int degree, const CellTreeSettings&);

  /// Tiles of the first level: disjoint, and all surface is in them.
  std::size_t tile_count() const { return places_.size(); }
  Box3 tile_box(std::size_t i) const { return places_[i].box(); }
  const Tile& tile(std::size_t i) const;
  /// Null when nobody has asked for it yet.
  const Tile* tile_if_made(std::size_t i) const { return tiles_[i].peek(); }
  const Tile& child(const Tile&, int slot) const;
  static Cell cell(const Tile&, int slot);

  /// The cell of a tile of the first level that holds a point, or of those that do not the nearest. Precondition: a ray
  /// has hit something in this tile.
  Cell nearest_cell(std::size_t tile, const Vec3d&) const;

  /// The sources around a cell, to the errors of `fine`; all near ones are pieces.
  Surroundings surroundings(const Cell&) const;
  /// The same to the errors of `coarse`.
  Surroundings coarse_surroundings(const Cell&) const;

  /// Of all tiles made so far, or, when `divide`, of all there are.
  void for_each_tile(bool divide, const std::function<void(const Tile&)>&) const;
  /// All cells; divides what is not divided yet.
  std::vector<Cell> cells() const;
  /// Cells and bytes of what has been made so far.
  struct Size {
    std::size_t cells = 0, bytes = 0;
  };
  Size size() const;

 private:
  struct Branch;
  struct Level;
  void place_tiles();
  bool has_too_many_tiles() const;
  bool is_small_enough(const Divider::Octant&, const Vec3d& center, double half, int level) const;
  bool is_hardly_met(const Divider::Octant&, const Vec3d& center, double half) const;
  void expand(const Branch&, int depth, Level& out) const;
  std::unique_ptr<const Tile> divide(const TilePlace&) const;
  Surroundings coarse_around(const TilePlace&) const;
  const KeptSurroundings& fine_around(const Tile&) const;
  const KeptSurroundings& fine_around_octant(const Tile&, int octant) const;

  const SourceTree& sources_;
  const NearFar& coarse_;
  const NearFar& fine_;
  Divider divider_;
  CellTreeSettings settings_;
  double most_thinnest_, most_thinnest_if_hardly_met_;
  UpperCubes above_;
  std::vector<TilePlace> places_;
  std::unique_ptr<Lazy<Tile>[]> tiles_;
};

}  // namespace marrow
