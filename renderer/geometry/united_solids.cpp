#include "renderer/geometry/united_solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "field/math/growing_steps.h"

namespace marrow {
namespace {

// Of values near 1: more than sums of floats put a hit off. So far inside none of them takes a place to be outside.
constexpr double clearly = 1e-5, surely = 1e-3;
// What doubles may round.
constexpr double least_margin = 1e-12;
constexpr double infinity = std::numeric_limits<double>::infinity();

// What a solid stepped off its surface, or, where it found no step, what places there are rounded by.
double first_step(const SurfaceHit& hit, const Box3& reach) {
  return std::max(length(hit.outside - hit.position), std::ldexp(largest_coordinate(reach), -48));
}

// The field of a solid; 0 where it is clearly outside, which is all that is asked for there.
double value_or_outside(const Solid& solid, const Vec3d& p) {
  return solid.clear_side(p) == Side::Outside ? 0 : solid.value(p);
}

Vec3d outward(const FieldSample& s) {
  const double steepness = length(s.gradient);
  return steepness > 0 ? s.gradient / -steepness : Vec3d{};
}

}  // namespace

Result<UnitedSolids> UnitedSolids::make(RTCDeviceTy* device, std::span<const PlacedSolid> solids) {
  UnitedSolids united(solids);
  // Whatever is alone in its body needs not be found.
  std::vector<Box3> reaches;
  for (const Placed& s : united.solids_) reaches.push_back(united.bodies_[s.body].size() > 1 ? s.reach : Box3{});
  auto index = BoxIndex::make(device, std::move(reaches));
  if (!index) return index.why();
  united.reaches_ = std::move(*index);
  return united;
}

UnitedSolids::UnitedSolids(std::span<const PlacedSolid> solids) {
  std::map<ObjectId, std::size_t> bodies;
  for (const PlacedSolid& placed : solids) {
    const std::size_t body = bodies.try_emplace(placed.object, bodies.size()).first->second;
    if (body == bodies_.size()) {
      bodies_.emplace_back();
      extents_.push_back({placed.object, {}});
    }
    bodies_[body].push_back(solids_.size());
    solids_.push_back({placed.solid.get(), placed.solid->reach(), body});
    extents_[body].box.include(placed.solid->extent());
    extents_[body].box.include(placed.solid->reach());
  }
}

// use(index) of those whose boxes hold p, in any order; it says whether to go on.
template <class Use>
void UnitedSolids::for_each_other(std::size_t solid, const Vec3d& p, const Use& use) const {
  const std::size_t body = solids_[solid].body;
  if (bodies_[body].size() == 1) return;
  reaches_.for_each_at(p,
                       [&](std::size_t other) { return other == solid || solids_[other].body != body || use(other); });
}

// The first of them, so that the order in which they are found shows nowhere.
std::optional<std::size_t> UnitedSolids::cover_of(const PartHit& hit, const Ray& ray) const {
  std::optional<std::size_t> cover;
  const Vec3d p = ray.at(hit.t);
  for_each_other(hit.solid, p, [&](std::size_t other) {
    if ((!cover || other < *cover) && value_or_outside(*solids_[other].solid, p) > 1 + clearly) cover = other;
    return true;
  });
  return cover;
}

// A ray that begins outside all others has met none of them before its first hit.
bool UnitedSolids::is_covered(const PartHit& hit, const Ray& ray) const {
  if (!hit.found) return false;
  bool may_begin_inside = false;
  for_each_other(hit.solid, ray.at(ray.t_min), [&](std::size_t) {
    may_begin_inside = true;
    return false;
  });
  return may_begin_inside && cover_of(hit, ray);
}

bool UnitedSolids::begins_inside(const Ray& ray) const {
  const Vec3d begin = ray.at(ray.t_min);
  bool is_inside = false;
  reaches_.for_each_at(begin, [&](std::size_t s) {
    const Solid& solid = *solids_[s].solid;
    is_inside = !solid.is_left_by(ray) && value_or_outside(solid, begin) > 1;
    return !is_inside;
  });
  return is_inside;
}

PartHit UnitedSolids::nearest(std::span<const std::size_t> solids, const Ray& ray,
                              std::vector<RayVisit>* visits) const {
  PartVisit visit(ray);
  visit.visits = visits;
  for (const std::size_t s : solids) {
    const Solid& solid = *solids_[s].solid;
    for (std::size_t element = 0; element < solid.element_count(); ++element) {
      ElementLog log = visit.before(solid);
      const auto t = solid.hit(element, ray, false, log);
      visit.take(s, solid, {.element = element}, t.value_or(infinity), log);
    }
  }
  return visit.best;
}

// Of a ray that is inside at t. It is asked for from where it is surely inside, or deepest by growing steps.
PartHit UnitedSolids::exit_of(std::size_t cover, const Ray& ray, double t, std::vector<RayVisit>* visits) const {
  const Solid& solid = *solids_[cover].solid;
  Ray onward = ray;
  onward.t_min = t;
  double deepest = solid.value(ray.at(t));
  for (double step = 1e-9 * max_component(solids_[cover].reach.size()); deepest < 1 + surely; step *= 2) {
    const double value = solid.value(ray.at(t + step));
    if (!(value > deepest)) break;
    deepest = value;
    onward.t_min = t + step;
  }
  return nearest(std::array{cover}, onward, visits);
}

PartHit UnitedSolids::uncovered(PartHit hit, const Ray& ray, std::vector<RayVisit>* visits) const {
  while (hit.found) {
    const auto cover = cover_of(hit, ray);
    if (!cover) break;
    PartHit exit = exit_of(*cover, ray, hit.t, visits);
    exit.note_undecided(hit.undecided, hit.undecided_in);
    if (exit.found && !(exit.t > hit.t)) break;
    hit = exit;
  }
  return hit;
}

PartHit UnitedSolids::first_hit(const Ray& ray, std::vector<RayVisit>* visits) const {
  PartHit best;
  for (const Body& body : bodies_) {
    PartHit hit = uncovered(nearest(body, ray, visits), ray, visits);
    hit.note_undecided(best.undecided, best.undecided_in);
    best.note_undecided(hit.undecided, hit.undecided_in);
    if (hit.found && (hit.t < best.t || (hit.t == best.t && hit.solid < best.solid))) best = hit;
  }
  return best;
}

double UnitedSolids::largest_beside(std::size_t solid, const Vec3d& p) const {
  const auto value = [&](std::size_t s) { return value_or_outside(*solids_[s].solid, p); };
  double largest = solids_[solid].reach.contains(p) ? value(solid) : 0;
  for_each_other(solid, p, [&](std::size_t other) {
    largest = std::max(largest, value(other));
    return true;
  });
  return largest;
}

std::optional<Vec3d> UnitedSolids::outside_along(std::size_t solid, const Vec3d& from, const Vec3d& way,
                                                 const GrowingSteps& steps, double margin) const {
  return first_place_along(from, way, steps, [&](const Vec3d& p) { return largest_beside(solid, p) < 1 - margin; });
}

// Away from both, back along the ray or on along it, or, where two all but touch, to a side: the first of growing steps
// that is outside all of the body.
void UnitedSolids::free_start(std::size_t solid, const Ray& ray, SurfaceHit& hit) const {
  std::optional<std::size_t> nearest;
  double largest = 1 - clearly;
  for_each_other(solid, hit.outside, [&](std::size_t other) {
    const double value = value_or_outside(*solids_[other].solid, hit.outside);
    if (!(value > largest || (value == largest && other < nearest))) return true;
    nearest = other;
    largest = value;
    return true;
  });
  if (!nearest) return;
  const Vec3d normal = hit.normal, away = outward(solids_[*nearest].solid->sample(hit.outside)),
              back = -ray.direction.vec();
  const Box3& reach = solids_[solid].reach;
  const double first = first_step(hit, reach);
  const GrowingSteps steps{first, 2, std::max(1e-2 * max_component(reach.size()), 16 * first)};
  const Frame frame = Frame::around(hit.normal);
  for (const double margin : {3 * clearly, least_margin})
    for (const Vec3d& way : {normal + away, back, away + back, normal + back, away, -back, frame.to_world({1, 0, 0}),
                             frame.to_world({-1, 0, 0}), frame.to_world({0, 1, 0}), frame.to_world({0, -1, 0})}) {
      if (!(length_squared(way) > 0)) continue;
      if (const auto start = outside_along(solid, hit.position, way, steps, margin)) {
        hit.outside = *start;
        return;
      }
    }
}

std::optional<Vec3d> UnitedSolids::start_before(std::size_t solid, const Ray& ray, const SurfaceHit& hit) const {
  if (!(dot(ray.direction, hit.normal) < 0)) return {};
  const Box3& reach = solids_[solid].reach;
  const double longest = std::min(hit.t - ray.t_min, 1e-2 * max_component(reach.size()));
  if (!(longest > 0)) return {};
  // The longest is one of them.
  const GrowingSteps steps{std::min(first_step(hit, reach), longest), 2, std::nextafter(longest, infinity)};
  for (const double margin : {3 * clearly, least_margin})
    if (const auto start = outside_along(solid, hit.position, -ray.direction, steps, margin)) return start;
  return {};
}

bool UnitedSolids::may_part(const Vec3d& a, const Vec3d& b, ObjectId of) const {
  constexpr std::size_t quickly_asked = 16;
  if (extents_.size() > quickly_asked) return true;
  Box3 between{a, a};
  between.include(b);
  return std::ranges::any_of(extents_, [&](const Extent& e) { return e.object != of && do_overlap(e.box, between); });
}

bool UnitedSolids::is_outside(std::size_t solid, const Vec3d& p) const {
  return largest_beside(solid, p) < 1 - least_margin;
}

}  // namespace marrow
