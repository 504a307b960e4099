#include "field/trace/general/tree_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "field/number/places_in.h"
#include "field/number/variables_at.h"
#include "field/trace/cells/divider.h"

namespace marrow {
namespace {

// 2^6 cells along the longest side: finer cells cost more to make than they save. Deeper only below warps, which make
// searches dearer, where a tree of many nodes goes on getting smaller, operators still have many operands that may not
// count, or a blend still has skeletons that are too near for sums over nodes.
constexpr int max_level = 6, max_level_of_warped = 7, max_level_of_leaf = 5, max_level_of_list = 8, max_level_near = 11,
              max_level_of_many = 24;
constexpr std::size_t many_records = 64, few_operands = 8;
// Cells of that level and deeper need more rays than so many of a camera in the half side (README). Where samples are
// not known they are taken to be as many as a picture mostly has.
constexpr int min_level_of_few_rays = 4;
constexpr double few_rays = 1.5, likely_samples = 16;
// A part of space whose tree has more than this share of the nodes of the one around it shares that.
constexpr double worth_a_copy = 0.7;
// Neighbours overlap by more than what the errors of their fields move a root; their trees hold a little farther.
constexpr double overlap = 1e-6, validity = 4e-6;

bool excludes_zero(const Interval& x) { return x.lo > 0 || x.hi < 0; }

// Of a cell, with some room to where its tree ends to hold.
Box3 where_it_holds(const Box3& cell) { return cell.padded(0.25 * validity * cell.size().x); }

bool is_list(const FieldTree& tree) { return operands_that_may_go(tree) > few_operands; }

bool is_fine_enough(const FieldTree& tree, bool shrinks, bool one_sheet, int level) {
  const std::size_t records = tree.records().size();
  if (records > many_records && shrinks && level < max_level_of_many) return false;
  if (level < max_level_near && is_mostly_near(tree)) return false;
  if (level < max_level_of_list && is_list(tree)) return false;
  const int most = records <= 1 ? max_level_of_leaf : is_warped(tree) ? max_level_of_warped : max_level;
  return level >= most || (one_sheet && level >= 2);
}

// Whether so few rays of a camera come that dividing a cell would cost more than it saves them. Later samples come
// between those of the first one.
bool is_hardly_met(const RaySpacing* spacing, const Box3& cell, int level) {
  if (spacing == nullptr || level < min_level_of_few_rays) return false;
  const double half = 0.5 * cell.size().x, samples = spacing->samples > 0 ? spacing->samples : likely_samples;
  return half < few_rays * spacing->in_cube(cell.center(), half) / std::sqrt(samples);
}

}  // namespace

Interval clip(const Box3& cell, const Ray& ray) {
  const Box3 box = cell.padded(0.5 * cell.size().x * overlap);
  Interval t{ray.t_min, Box3::inf};
  for (std::size_t i = 0; i < 3; ++i) {
    const double o = ray.origin[i], d = ray.direction.vec()[i];
    if (d == 0) {
      if (o < box.lower[i] || o > box.upper[i]) return {1, 0};
      continue;
    }
    const double a = (box.lower[i] - o) / d, b = (box.upper[i] - o) / d;
    t.lo = std::max(t.lo, std::min(a, b));
    t.hi = std::min(t.hi, std::max(a, b));
  }
  return t;
}

// The cube of the box, with a little room.
std::unique_ptr<const TreeCell> TreeCell::root(const FieldTree& tree, const Box3& box, std::uint32_t record,
                                               const TreeDivision& division) {
  std::unique_ptr<TreeCell> cell(new TreeCell(box.center(), 0.5 * max_component(box.size()) * (1 + 1e-6), 0, division));
  cell->tree_ = std::make_shared<const FieldTree>(localized(tree, cell->box().padded(cell->half_ * validity), record));
  return cell;
}

bool TreeCell::holds(const Vec3d& p) const { return where_it_holds(box()).contains(p); }

Box3 TreeCell::octant_box(std::size_t i) const {
  const Vec3d center = octant_center(center_, half_, static_cast<int>(i));
  return Box3{center, center}.padded(half_ / 2);
}

const TreeCell* TreeCell::octant(std::size_t i) const {
  return octants_[i].get([&] { return std::make_unique<const Octant>(make_octant(i)); }).get();
}

// The octant, unless bounds prove all of it outside or inside, or it is traced otherwise.
std::unique_ptr<const TreeCell> TreeCell::make_octant(std::size_t i) const {
  std::unique_ptr<TreeCell> cell(
      new TreeCell(octant_center(center_, half_, static_cast<int>(i)), half_ / 2, level_ + 1, division_));
  const Box3 around = cell->box().padded(cell->half_ * validity);
  if (division_.lent != nullptr && division_.lent->decides_around(around)) return {};
  // As the larger cube sums it: enough to drop most of what can be dropped, before anything is made for it. Where
  // hardly a ray comes that is all, until few operands are left.
  auto [own, bounds] = restricted_and_bounded(*tree_, around);
  if (!bounds.contains(1)) return {};
  const bool is_rare = is_hardly_met(division_.spacing.get(), cell->box(), cell->level_);
  const bool only_thinned = is_rare && is_list(own);
  if (!only_thinned) own = localized(own, around);
  const auto f = value(own, variables_at<Jet<Interval, 3>>(places_in(around)));
  if (!f.value.contains(1)) return {};
  const bool one_sheet = excludes_zero(f.slope[0]) || excludes_zero(f.slope[1]) || excludes_zero(f.slope[2]);
  const std::size_t records = own.records().size();
  const bool shrinks = static_cast<double>(records) < worth_a_copy * static_cast<double>(tree_->records().size());
  cell->is_leaf_ = is_fine_enough(own, shrinks, one_sheet, cell->level_) || (is_rare && !only_thinned);
  cell->tree_ = shrinks || records <= many_records ? std::make_shared<const FieldTree>(std::move(own)) : tree_;
  return cell;
}

const TreeCell& TreeCell::leaf_at(const Vec3d& p) const {
  const TreeCell* here = this;
  while (!here->is_leaf_) {
    const TreeCell* next = nullptr;
    for (std::size_t i = 0; i < octant_count && next == nullptr; ++i)
      if (where_it_holds(here->octant_box(i)).contains(p)) next = here->octant(i);
    if (next == nullptr) break;
    here = next;
  }
  return *here;
}

std::size_t TreeCell::bytes() const {
  double sum = sizeof *this + static_cast<double>(bytes_of(*tree_)) / static_cast<double>(tree_.use_count());
  for (const auto& octant : octants_)
    if (const Octant* made = octant.peek()) sum += sizeof *made + (*made ? static_cast<double>((*made)->bytes()) : 0);
  return static_cast<std::size_t>(sum);
}

}  // namespace marrow
