#include "field/trace/tree_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "field/trace/cell_tree.h"
#include "field/trace/crossing.h"

namespace marrow {
namespace {

// 2^6 cells along the longest side: finer cells cost more to build than they save, most of all for blends, whose sums
// do not get shorter in smaller cells. Deeper only where a tree of many nodes goes on getting smaller.
constexpr int max_level = 6, max_level_of_leaf = 5, max_level_of_many = 24;
constexpr std::size_t many_records = 64;
// A part of space whose tree has more than this share of the nodes of the one around it shares that.
constexpr double worth_a_copy = 0.7;
// As many as a level may have to be divided further: bounds that do not shrink would keep all of space.
constexpr std::size_t max_branches = 50'000;
// Nodes of all trees of a level, which dividing it further visits eight times, at 0.2 us each.
constexpr std::size_t max_records = 8'000'000;
// Of more members than this, those without operators are not divided: a ray that meets the box of one has few others
// to meet, and a search along it takes less than cells take memory.
constexpr std::size_t few_members = 64;
// Neighbours overlap so that no root falls between them by rounding; the restricted trees hold a little farther.
constexpr double overlap = 1e-6, validity = 4e-6;

Vec3<Interval> span_of(const Box3& box) {
  return {{box.lower.x, box.upper.x}, {box.lower.y, box.upper.y}, {box.lower.z, box.upper.z}};
}

Vec3<Jet<Interval, 3>> with_slopes(const Vec3<Interval>& p) {
  using X = Jet<Interval, 3>;
  return {X::variable(p.x, 0), X::variable(p.y, 1), X::variable(p.z, 2)};
}

bool excludes_zero(const Interval& x) { return x.lo > 0 || x.hi < 0; }

struct Branch {
  Vec3d center;
  double half;
  std::shared_ptr<const FieldTree> tree;
  bool is_cell;

  Box3 box() const { return Box3{center, center}.padded(half); }
};

bool is_fine_enough(std::size_t records, bool shrinks, bool one_sheet, int level) {
  if (records > many_records && shrinks && level < max_level_of_many) return false;
  return level >= (records <= 1 ? max_level_of_leaf : max_level) || (one_sheet && level >= 2);
}

// What is to be done with a part of space.
std::optional<Branch> examined(const std::shared_ptr<const FieldTree>& parent, const Vec3d& center, double half,
                               int level) {
  Branch b{center, half, parent, false};
  FieldTree own = localized(*parent, Box3{center, center}.padded(half * (1 + validity)));
  const auto f = value(own, with_slopes(span_of(b.box().padded(half * validity))));
  if (!f.value.contains(1)) return {};
  const bool one_sheet = excludes_zero(f.slope[0]) || excludes_zero(f.slope[1]) || excludes_zero(f.slope[2]);
  const std::size_t records = own.records().size();
  const bool shrinks = static_cast<double>(records) < worth_a_copy * static_cast<double>(parent->records().size());
  if (shrinks || records <= many_records) b.tree = std::make_shared<const FieldTree>(std::move(own));
  b.is_cell = is_fine_enough(records, shrinks, one_sheet, level);
  return b;
}

// The cube of a box, with a little room.
Branch root_of(const FieldTree& tree, const Member& member) {
  const Vec3d center = member.bounds.center();
  const double half = 0.5 * max_component(member.bounds.size()) * (1 + 1e-6);
  FieldTree own = localized(tree, Box3{center, center}.padded(half * (1 + validity)), member.record);
  return {center, half, std::make_shared<const FieldTree>(std::move(own)), false};
}

// The box without slabs at its sides that bounds prove to be outside.
Box3 trimmed(const FieldTree& tree, const Member& member) {
  constexpr int halvings = 10;
  Box3 box = member.bounds;
  for (std::size_t i = 0; i < 3; ++i)
    for (Vec3d Box3::*side : {&Box3::lower, &Box3::upper}) {
      double outside = (box.*side)[i], unknown = box.center()[i];
      for (int step = 0; step < halvings; ++step) {
        const double cut = 0.5 * (outside + unknown);
        Box3 slab = box;
        (slab.*(side == &Box3::lower ? &Box3::upper : &Box3::lower))[i] = cut;
        (value(tree, span_of(slab), member.record).hi < 1 ? outside : unknown) = cut;
      }
      (box.*side)[i] = outside;
    }
  return box;
}

}  // namespace

Result<TreeTracer> TreeTracer::make(FieldTree tree) {
  TreeTracer made(std::move(tree));
  const std::vector<Member> all = members(made.tree_);
  for (const Member& member : all) {
    if (member.bounds.empty()) continue;
    if (!(is_finite(member.bounds.lower) && is_finite(member.bounds.upper)))
      return failure("the surface of this field has no end; intersect it with something bounded");
    made.bounds_.include(member.bounds);
    if (member.is_leaf && all.size() > few_members)
      made.cells_.push_back({trimmed(made.tree_, member), member.record, nullptr});
    else made.divide(member);
  }
  return made;
}

// Level by level, so that the order of cells does not depend on threads.
void TreeTracer::divide(const Member& member) {
  std::vector<Branch> level{root_of(tree_, member)};
  for (int depth = 1; !level.empty(); ++depth) {
    std::size_t records = 0;
    for (const Branch& b : level) records += b.tree->records().size();
    const bool is_last = level.size() * 8 > max_branches || (depth > 1 && records > max_records);
    std::vector<std::optional<Branch>> octants(level.size() * 8);
    tbb::parallel_for(std::size_t{0}, octants.size(), [&](std::size_t i) {
      const Branch& b = level[i / 8];
      octants[i] = examined(b.tree, octant_center(b.center, b.half, static_cast<int>(i % 8)), b.half / 2, depth);
    });
    level.clear();
    for (std::optional<Branch>& b : octants) {
      if (!b) continue;
      if (b->is_cell || is_last) cells_.push_back({b->box(), member.record, std::move(b->tree)});
      else level.push_back(*std::move(b));
    }
  }
}

namespace {

// The part of the ray inside the box and a little beyond.
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

}  // namespace

std::optional<CellHit> TreeTracer::first_hit(std::size_t cell, const Ray& ray, bool any, CellLog& log) const {
  const Cell& c = cells_[cell];
  Interval t = clip(c.box, ray);
  log.enter = t.lo;
  if (any) t.hi = std::min(t.hi, ray.t_max);
  if (!(t.lo <= t.hi)) return {};
  const CrossingSearch search = c.tree ? find_crossing(*c.tree, FieldTree::whole, ray, t.lo, t.hi, any)
                                       : find_crossing(tree_, c.member, ray, t.lo, t.hi, any);
  log.evaluations += search.evaluations;
  log.undecided = std::min(log.undecided, search.undecided);
  return search.t && *search.t <= ray.t_max ? std::optional(CellHit{*search.t}) : std::nullopt;
}

// use(tree, record) of what is equal to the member at p.
template <class Use>
auto TreeTracer::with_field_near(const Cell& cell, const Vec3d& p, const Use& use) const {
  const bool is_near = cell.tree && cell.box.padded(0.5 * validity * cell.box.size().x).contains(p);
  return is_near ? use(*cell.tree, FieldTree::whole) : use(tree_, cell.member);
}

// Beside the surface: the shortest of growing steps after which the field is certainly below 1.
SurfacePoint TreeTracer::surface_at(std::size_t cell, const Vec3d& position) const {
  using X = Jet<double, 3>;
  const Cell& c = cells_[cell];
  const Vec3<X> at{X::variable(position.x, 0), X::variable(position.y, 1), X::variable(position.z, 2)};
  const X f = with_field_near(c, position,
                              [&](const FieldTree& tree, std::uint32_t record) { return value(tree, at, record); });
  SurfacePoint out{.normal = normalize(Vec3d{-f.slope[0], -f.slope[1], -f.slope[2]}), .outside = position};
  const double size = std::max(largest_coordinate(c.box), c.box.size().x);
  for (double step = 4 * rounding::ulp * size; step < size; step *= 2) {
    const Vec3d p = out.outside = position + out.normal * step;
    const Vec3<Interval> there{Interval(p.x), Interval(p.y), Interval(p.z)};
    const auto enclosed = [&](const FieldTree& tree, std::uint32_t record) { return value(tree, there, record); };
    if (with_field_near(c, p, enclosed).hi < 1) break;
  }
  return out;
}

MaterialId TreeTracer::material_at(std::size_t cell, const Vec3d& position) const {
  return with_field_near(cells_[cell], position, [&](const FieldTree& tree, std::uint32_t record) {
    return strongest_material(tree, position, record);
  });
}

std::size_t TreeTracer::bytes() const {
  const auto bytes_of = [](const FieldTree& tree) {
    return sizeof tree + tree.records().size() * (sizeof(FieldTree::Record) + sizeof(std::uint32_t));
  };
  double bytes = static_cast<double>(cells_.capacity() * sizeof(Cell) + bytes_of(tree_));
  for (const Cell& c : cells_)
    if (c.tree) bytes += static_cast<double>(bytes_of(*c.tree)) / static_cast<double>(c.tree.use_count());
  return static_cast<std::size_t>(bytes);
}

}  // namespace marrow
