#include "field/trace/cells/cell_tree.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "field/math/elementary.h"
#include "field/trace/cells/block.h"

namespace marrow {
namespace {

constexpr double open_all = NearFar::open_all;

// How large a cell may be where rays are few, of the local radius.
constexpr double most_radii = 12;

// How large a cell may be, of the thinnest radius close by. Places in float are off by some 3e-8 half sides, which
// moves the field by n - 1 times that over the radius: 2e-6 here, 3e-6 where hardly a ray comes.
double most_thinnest(int degree) { return 60.0 / (degree - 1); }
double most_thinnest_if_hardly_met(int degree) { return std::min(32.0, 96.0 / (degree - 1)); }

// Squared, of a point outside; 0 inside.
double distance2(const Box3& box, const Vec3d& p) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double gap = std::max({0.0, box.lower[i] - p[i], p[i] - box.upper[i]});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace

// An upper cube to be expanded.
struct CellTree::Branch {
  CubeView view;
  int octant;  // of the parent
  const UpperCube* cube;
};

// What one cube of the upper levels gives to the next, in which branches stand for themselves.
struct CellTree::Level {
  std::vector<TilePlace> tiles;
  std::vector<Branch> branches;
};

void CellTree::expand(const Branch& branch, int depth, Level& out) const {
  const CubeView& parent = branch.view;
  const double half = parent.half / 2, cells_along = integer_power(4, settings_.tile_levels);
  const auto octants = divider_.octants(parent);
  for (int i = 0; i < 8; ++i) {
    const Divider::Octant& octant = octants[static_cast<std::size_t>(i)];
    if (!octant.mixed) continue;
    const Vec3d center = octant_center(parent.center, parent.half, i);
    if (half <= cells_along * settings_.cell_size * octant.local_radius || depth + 2 >= settings_.deepest_level ||
        is_hardly_met(octant, center, half / 2))
      out.tiles.push_back({.center = center, .half = half, .level = depth, .slot = i, .above = branch.cube});
    else out.branches.push_back({divider_.child(parent, i), i, branch.cube});
  }
}

CellTree::CellTree(const SourceTree& sources, const NearFar& coarse, const NearFar& fine, const IsoCurve& iso,
                   const BlockKernels& kernels, int degree, const CellTreeSettings& settings)
    : sources_(sources),
      coarse_(coarse),
      fine_(fine),
      divider_(sources, coarse, iso, kernels, degree),
      settings_(settings),
      most_thinnest_(most_thinnest(degree)),
      most_thinnest_if_hardly_met_(most_thinnest_if_hardly_met(degree)),
      above_(sources, coarse, fine, kernels) {
  if (sources.pieces().empty()) return;
  for (place_tiles(); has_too_many_tiles(); place_tiles()) ++settings_.tile_levels;
  tiles_.reset(new Lazy<Tile>[places_.size()]);
}

// Level by level: the branches of a level are expanded in parallel, and gathered in their order.
void CellTree::place_tiles() {
  places_.clear();
  above_.clear();
  std::vector<Branch> level{{divider_.root(), 0, nullptr}};
  for (int depth = 1; !level.empty(); ++depth) {
    for (Branch& b : level) b.cube = &above_.add(b.view.center, b.view.half, b.cube, b.octant);
    std::vector<Level> expansions(level.size());
    tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) { expand(level[i], depth, expansions[i]); });
    level.clear();
    for (Level& e : expansions) {
      std::move(e.branches.begin(), e.branches.end(), std::back_inserter(level));
      places_.insert(places_.end(), e.tiles.begin(), e.tiles.end());
    }
  }
}

// All placements of the blend list its tiles, of some 200 bytes each time. Figures in the README.
bool CellTree::has_too_many_tiles() const {
  constexpr int most_levels = 4;
  constexpr std::size_t many_small = std::size_t{1} << 16, many = std::size_t{1} << 19;
  const std::size_t placements = settings_.spacing ? settings_.spacing->views.size() : 1;
  const std::size_t most = settings_.tile_levels == 1 ? many_small : many;
  return settings_.tile_levels < most_levels && places_.size() * placements > most;
}

const Tile& CellTree::tile(std::size_t i) const {
  return tiles_[i].get([&] { return divide(places_[i]); });
}

const Tile& CellTree::child(const Tile& tile, int slot) const {
  return tile.child(slot).get([&] {
    const TilePlace& p = tile.place();
    return divide({.center = slot_center(p.center, p.half, slot),
                   .half = p.half / 4,
                   .level = p.level + 2,
                   .slot = slot,
                   .parent = &tile});
  });
}

CellTree::Cell CellTree::cell(const Tile& tile, int slot) {
  const TilePlace& p = tile.place();
  const int octant = path_of(slot).outer;
  if (tile.content().large_cells >> octant & 1)
    return {octant_center(p.center, p.half, octant), p.half / 2, &tile, slot_at({octant, 0}), true};
  return {slot_center(p.center, p.half, slot), p.half / 4, &tile, slot, false};
}

// The first of the nearest slots at each level; ties and roundings at faces do not matter, blocks agree there.
CellTree::Cell CellTree::nearest_cell(std::size_t index, const Vec3d& p) const {
  const Tile* here = &tile(index);
  for (;;) {
    const TilePlace& place = here->place();
    const TileContent& content = here->content();
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint64_t left = content.cells | content.tiles; left != 0; left &= left - 1) {
      const int slot = std::countr_zero(left);
      const bool is_cell = content.cells >> slot & 1;
      const Box3 box = is_cell ? cell(*here, slot).box()
                               : TilePlace{slot_center(place.center, place.half, slot), place.half / 4}.box();
      const double d = distance2(box, p);
      if (d < least) {
        least = d;
        best = slot;
      }
    }
    if (content.cells >> best & 1) return cell(*here, best);
    here = &child(*here, best);
  }
}

Surroundings CellTree::coarse_around(const TilePlace& place) const {
  if (place.parent == nullptr)
    return refined(coarse_, sources_, &above_.coarse_around(*place.above), place.slot, place.center, place.half,
                   largest_coarse_group);
  const SlotPath path = path_of(place.slot);
  Surroundings s;
  s.far = place.parent->coarse().far.whole().of_child(path.outer).of_child(path.inner);
  s.near = coarse_.split(sources_, place.parent->coarse().near, place.center, place.half, largest_coarse_group, s.far);
  return s;
}

// A cell of many radii, but of so few rays that long lists cost less than more cells.
bool CellTree::is_hardly_met(const Divider::Octant& octant, const Vec3d& center, double half) const {
  constexpr double very_few = 0.625;  // of the rays below which a cell is hardly worth making
  return settings_.spacing && half > most_radii * octant.local_radius &&
         half <= most_thinnest_if_hardly_met_ * octant.thinnest &&
         half <= very_few * settings_.spacing->least_cell(center, half);
}

// A cell narrower than some rays is hardly worth making; but beyond some radii its lists grow too long, and beyond some
// of the thinnest radii positions in float are too rough.
bool CellTree::is_small_enough(const Divider::Octant& octant, const Vec3d& center, double half, int level) const {
  if (level >= settings_.deepest_level || is_hardly_met(octant, center, half)) return true;
  if (half > most_thinnest_ * octant.thinnest) return false;
  if (half <= settings_.cell_size * octant.local_radius) return true;
  return settings_.spacing && half <= most_radii * octant.local_radius &&
         half <= settings_.spacing->least_cell(center, half);
}

std::unique_ptr<const Tile> CellTree::divide(const TilePlace& place) const {
  const CubeView whole{place.center, place.half, KeptSurroundings(coarse_around(place))};
  const auto outer = divider_.octants(whole);
  TileContent content;
  for (int i = 0; i < 8; ++i) {
    if (!outer[static_cast<std::size_t>(i)].mixed) continue;
    const Vec3d center = octant_center(place.center, place.half, i);
    if (is_small_enough(outer[static_cast<std::size_t>(i)], center, place.half / 2, place.level + 1)) {
      content.large_cells = static_cast<std::uint8_t>(content.large_cells | 1U << i);
      content.cells |= std::uint64_t{1} << slot_at({i, 0});
      continue;
    }
    const auto inner = divider_.octants(divider_.child(whole, i));
    for (int k = 0; k < 8; ++k) {
      const Divider::Octant& slot = inner[static_cast<std::size_t>(k)];
      if (!slot.mixed) continue;
      const bool is_cell =
          is_small_enough(slot, octant_center(center, place.half / 2, k), place.half / 4, place.level + 2);
      (is_cell ? content.cells : content.tiles) |= std::uint64_t{1} << slot_at({i, k});
    }
  }
  return std::make_unique<const Tile>(place, whole.sources, content);
}

const KeptSurroundings& CellTree::fine_around(const Tile& tile) const {
  return tile.fine().get([&] {
    const TilePlace& p = tile.place();
    const bool is_first = p.parent == nullptr;
    const SlotPath path = path_of(p.slot);
    const KeptSurroundings& parent =
        is_first ? above_.fine_around(*p.above) : fine_around_octant(*p.parent, path.outer);
    return std::make_unique<const KeptSurroundings>(
        refined(fine_, sources_, &parent, is_first ? p.slot : path.inner, p.center, p.half, largest_fine_group));
  });
}

const KeptSurroundings& CellTree::fine_around_octant(const Tile& tile, int octant) const {
  return tile.fine_of_octant(octant).get([&] {
    const TilePlace& p = tile.place();
    return std::make_unique<const KeptSurroundings>(refined(fine_, sources_, &fine_around(tile), octant,
                                                            octant_center(p.center, p.half, octant), p.half / 2,
                                                            largest_fine_group));
  });
}

Surroundings CellTree::surroundings(const Cell& cell) const {
  const SlotPath path = path_of(cell.slot);
  if (cell.large)
    return refined(fine_, sources_, &fine_around(*cell.tile), path.outer, cell.center, cell.half, open_all);
  return refined(fine_, sources_, &fine_around_octant(*cell.tile, path.outer), path.inner, cell.center, cell.half,
                 open_all);
}

// The list of a tile is short enough to be asked for each of its cells.
Surroundings CellTree::coarse_surroundings(const Cell& cell) const {
  const SlotPath path = path_of(cell.slot);
  Surroundings s{.near = {}, .far = cell.tile->coarse().far.whole().of_child(path.outer)};
  if (!cell.large) s.far = s.far.of_child(path.inner);
  s.near = coarse_.split(sources_, cell.tile->coarse().near, cell.center, cell.half, open_all, s.far);
  return s;
}

void CellTree::for_each_tile(bool divide, const std::function<void(const Tile&)>& visit) const {
  std::vector<const Tile*> open;
  for (std::size_t i = places_.size(); i-- > 0;)
    if (const Tile* t = divide ? &tile(i) : tiles_[i].peek()) open.push_back(t);
  while (!open.empty()) {
    const Tile& t = *open.back();
    open.pop_back();
    visit(t);
    for (int slot = 63; slot >= 0; --slot)
      if (t.content().tiles >> slot & 1)
        if (const Tile* c = divide ? &child(t, slot) : t.child(slot).peek()) open.push_back(c);
  }
}

std::vector<CellTree::Cell> CellTree::cells() const {
  std::vector<Cell> all;
  for_each_tile(true, [&](const Tile& t) {
    for (int slot = 0; slot < 64; ++slot)
      if (t.content().cells >> slot & 1) all.push_back(cell(t, slot));
  });
  return all;
}

CellTree::Size CellTree::size() const {
  Size s{.cells = 0, .bytes = places_.capacity() * (sizeof(TilePlace) + sizeof(Lazy<Tile>)) + above_.bytes()};
  for_each_tile(false, [&](const Tile& t) {
    s.cells += static_cast<std::size_t>(std::popcount(t.content().cells));
    s.bytes += t.bytes();
  });
  return s;
}

}  // namespace marrow
