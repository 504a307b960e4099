#include "field/trace/general/tree_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <tbb/parallel_for.h>

#include "field/number/places_in.h"
#include "field/trace/general/crossing.h"
#include "field/trace/general/tree_fields.h"

namespace marrow {
namespace {

// Space is divided so far before rays come: into some hundred elements at most of each member.
constexpr int first_levels = 3;
// Of more members than this, those without operators are not divided: a ray that meets the box of one has few others
// to meet, and a search along it takes less than cells take memory.
constexpr std::size_t few_members = 64;
// Of so many members at most, all are asked at a crossing whether it is inside them: 2 us.
constexpr std::size_t most_asked = 1024;
// Bounds of members in cells are off by less.
constexpr double members_are_off = 1e-6;

// The box without slabs at its sides that bounds prove to be outside.
Box3 trimmed(const FieldTree& tree, const UnionMember& member) {
  constexpr int halvings = 10;
  Box3 box = member.bounds;
  for (std::size_t i = 0; i < 3; ++i)
    for (Vec3d Box3::*side : {&Box3::lower, &Box3::upper}) {
      double outside = (box.*side)[i], unknown = box.center()[i];
      for (int step = 0; step < halvings; ++step) {
        const double cut = 0.5 * (outside + unknown);
        Box3 slab = box;
        (slab.*(side == &Box3::lower ? &Box3::upper : &Box3::lower))[i] = cut;
        (value(tree, places_in(slab), member.record).hi < 1 ? outside : unknown) = cut;
      }
      (box.*side)[i] = outside;
    }
  return box;
}

}  // namespace

Result<TreeTracer> TreeTracer::make(FieldTree tree, const Box3& within, TreeDivision division) {
  TreeTracer made(std::move(tree), std::move(division));
  std::vector<UnionMember> all = members(made.tree_);
  for (UnionMember& member : all) member.bounds = common(member.bounds, within);
  if (all.size() > 1 && all.size() <= most_asked) made.members_ = all;
  for (const UnionMember& member : all) {
    if (member.bounds.empty()) continue;
    if (!(is_finite(member.bounds.lower) && is_finite(member.bounds.upper)))
      return failure("the surface of this field has no end; intersect it with something bounded");
    made.bounds_.include(member.bounds);
    if (!(member.is_leaf && all.size() > few_members)) {
      made.divide(member);
      continue;
    }
    const Box3 box = trimmed(made.tree_, member);
    if (!made.is_inside_another(member.record, box)) made.cells_.push_back({box, member.record, nullptr});
  }
  return made;
}

// In the order of space.
void TreeTracer::divide(const UnionMember& member) {
  roots_.push_back(TreeCell::root(tree_, member.bounds, member.record, *division_));
  std::vector<const TreeCell*> level{roots_.back().get()};
  for (int depth = 1; !level.empty(); ++depth) {
    tbb::parallel_for(std::size_t{0}, level.size() * TreeCell::octant_count,
                      [&](std::size_t i) { level[i / TreeCell::octant_count]->octant(i % TreeCell::octant_count); });
    std::vector<const TreeCell*> next;
    for (const TreeCell* parent : level)
      for (std::size_t i = 0; i < TreeCell::octant_count; ++i) {
        const TreeCell* octant = parent->octant(i);
        if (octant == nullptr || is_inside_another(member.record, octant->box())) continue;
        if (octant->is_leaf() || depth == first_levels) cells_.push_back({octant->box(), member.record, octant});
        else next.push_back(octant);
      }
    level = std::move(next);
  }
}

namespace {

// Leaves in the order of the ray.
class CellSearch {
 public:
  // `is_covered(stretch)`: whether other members are proved to be all around it, so that a touch there is none.
  CellSearch(const Ray& ray, double body, bool any, CellLog& log,
             const std::function<bool(const Interval&)>& is_covered)
      : ray_(ray), body_(body), any_(any), log_(log), is_covered_(is_covered) {}

  std::optional<TreeHit> in(const TreeCell& cell, const Interval& t) {
    if (cell.is_leaf()) return in(cell.tree(), FieldTree::whole, t, &cell);
    struct Stretch {
      Interval t;
      std::size_t octant;
    };
    std::array<Stretch, TreeCell::octant_count> inside;
    std::size_t count = 0;
    for (std::size_t i = 0; i < TreeCell::octant_count; ++i) {
      Interval part = clip(cell.octant_box(i), ray_);
      part.hi = std::min(part.hi, t.hi);
      if (part.lo <= part.hi) inside[count++] = {part, i};
    }
    const auto end = inside.begin() + static_cast<std::ptrdiff_t>(count);
    std::stable_sort(inside.begin(), end, [](const Stretch& a, const Stretch& b) { return a.t.lo < b.t.lo; });
    std::optional<TreeHit> nearest;
    for (auto s = inside.begin(); s != end && !(nearest && nearest->t < s->t.lo); ++s) {
      const TreeCell* octant = cell.octant(s->octant);
      if (octant == nullptr) continue;
      if (const auto hit = in(*octant, s->t); hit && !(nearest && nearest->t <= hit->t)) {
        nearest = hit;
        if (any_) break;
      }
    }
    return nearest;
  }

  std::optional<TreeHit> in(const FieldTree& tree, std::uint32_t record, const Interval& t, const TreeCell* cell) {
    const CrossingSearch found = find_crossing(tree, record, ray_, t.lo, t.hi, body_, any_);
    log_.evaluations += found.evaluations;
    if (found.undecided < log_.undecided && !is_covered_({found.undecided, found.undecided_until}))
      log_.undecided = found.undecided;
    return found.t ? std::optional(TreeHit{*found.t, cell}) : std::nullopt;
  }

 private:
  const Ray& ray_;
  double body_;
  bool any_;
  CellLog& log_;
  const std::function<bool(const Interval&)>& is_covered_;
};

}  // namespace

std::optional<TreeHit> TreeTracer::first_hit(std::size_t cell, const Ray& ray, bool any, CellLog& log) const {
  const Cell& c = cells_[cell];
  Interval t = clip(c.box, ray);
  log.enter = t.lo;
  const double nearly_ended = 0x1p-30 * ray.size_at(t.hi);  // gaps are shorter
  const bool is_cut = any && ray.t_max + nearly_ended < t.hi;
  if (is_cut) t.hi = ray.t_max + nearly_ended;
  Ray onward = ray;
  double stride = t.hi - t.lo;
  // of half the body, as the first cells are eighths
  const double body = (1 << (first_levels - 1)) * max_component(c.box.size());
  const std::function<bool(const Interval&)> covered = [&](const Interval& stretch) {
    return !members_.empty() && largest_of_others(c.member, places_on(ray, stretch)).lo > 1 + sums_are_off;
  };
  while (t.lo <= t.hi) {
    // Any crossing is told by a place behind it: not what is_covered() asks for.
    CellSearch search(onward, body, any && members_.empty(), log, covered);
    const auto hit = c.part != nullptr ? search.in(*c.part, t) : search.in(tree_, c.member, t, nullptr);
    // Where any crossing may lie behind the end of the ray, the first one tells. So it does of a ray that ends in the
    // cell: this search has looked at other places, and may have met a film that is thinner than gaps.
    if (hit && (is_cut || (any && hit->t > ray.t_max - nearly_ended))) return first_hit(cell, ray, false, log);
    // A touch that may be there is one if the first hit is: that search may have looked at other places.
    if (any && !hit && log.undecided < Box3::inf) return first_hit(cell, ray, false, log);
    if (!hit || hit->t > ray.t_max) return {};
    if (members_.empty() || !(is_covered(c.member, ray, hit->t) || is_joint(c.member, ray, hit->t))) return hit;
    const double next = covered_until(c.member, ray, hit->t, stride);
    onward.t_min = t.lo = std::max(next, std::nextafter(t.lo, Box3::inf));
  }
  return {};
}

// Whether no crossing in the box is on the surface.
bool TreeTracer::is_inside_another(std::uint32_t member, const Box3& box) const {
  return !members_.empty() && largest_of_others(member, places_in(box)).lo > 1 + members_are_off;
}

// Whether another member is all around a crossing. For a ray from outside it is so only behind a crossing of that
// member: what is asked is the place before the crossing, by more than crossings are misplaced.
bool TreeTracer::is_covered(std::uint32_t member, const Ray& ray, double t) const {
  const double size = ray.size_at(t);
  const Vec3d p = ray.at(std::max(ray.t_min, t - 64 * rounding::ulp * size));
  return largest_of_others(member, p) > 1 + members_are_off;
}

// How far behind a crossing that is passed bounds prove at once that others are passed too: where a ray runs along a
// face inside another member, rounding makes one after the other. The next stride is longer or shorter, as that was so.
double TreeTracer::covered_until(std::uint32_t member, const Ray& ray, double t, double& stride) const {
  const double shortest = 0x1p-34 * ray.size_at(t);
  const Interval ahead(t, t + std::max(stride, shortest));
  const bool proved = largest_of_others(member, places_on(ray, ahead)).lo > 1 + sums_are_off;
  stride = proved ? 4 * (ahead.hi - t) : 0.25 * stride;
  return proved ? ahead.hi : t;
}

// Whether the ray goes on from the member into another one, or the other way, through a common face: members are above
// 1 before and behind, and bounds prove that between no more is outside than what sums and positions are off.
bool TreeTracer::is_joint(std::uint32_t member, const Ray& ray, double t) const {
  constexpr double least_reach = 1e-11, most_reach = 1e-8, rounding_of_sums = 1e-13;
  const double size = ray.size_at(t);
  const auto largest_at = [&](const auto& p) { return max(value(tree_, p, member), largest_of_others(member, p)); };
  // Where fields are flat sums tell the side only farther away.
  double by = least_reach * size;
  for (;; by *= 10) {
    if (by > most_reach * size || !(t - by > ray.t_min)) return false;
    const double off = std::min(largest_at(ray.at(t - by)), largest_at(ray.at(t + by))) - 1;
    if (off < 0) return false;
    if (off > rounding_of_sums) break;
  }
  const auto enclosure = [&](const Interval& along) { return largest_at(places_on(ray, along)); };
  const Interval here = enclosure(Interval(t));
  const double least = 1 - sums_are_off - 2 * (here.hi - here.lo), shortest = 4 * rounding::ulp * size;
  double from = t - by, step = 2 * by;
  while (from < t + by) {
    const double to = std::min(from + step, t + by);
    if (enclosure({from, to}).lo > least) {
      from = to;
      step *= 2;
    } else if (step > shortest) {
      step *= 0.5;
    } else {
      return false;
    }
  }
  return true;
}

std::size_t TreeTracer::bytes() const {
  std::size_t bytes = cells_.capacity() * sizeof(Cell) + bytes_of(tree_);
  for (const auto& root : roots_) bytes += root->bytes();
  return bytes;
}

}  // namespace marrow
