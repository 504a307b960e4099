// What a ray keeps on its way from part to part: in double, whatever floats the search of boxes goes by.
#pragma once

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "renderer/geometry/solid.h"

namespace marrow {

/// The nearest hit among the parts of solids. A hit lies no nearer than where its part begins: by rounding it may be
/// found just before, where another part has one, too, and the order in which parts are asked must not matter.
struct PartHit {
  double t = std::numeric_limits<double>::infinity();
  std::size_t solid = 0, element = 0;
  const void* place = nullptr;                                 ///< ElementLog's
  double enter = 0;                                            ///< where the ray came into the part
  double undecided = std::numeric_limits<double>::infinity();  ///< the first of all parts that were visited
  std::size_t undecided_in = 0;                                ///< the solid of that one
  bool found = false, begins_inside = false;  ///< begins_inside: as in ElementLog; then the hit is not one

  double reached() const { return std::max(t, enter); }
  void note_undecided(double where, std::size_t of_solid) {
    if (std::tie(where, of_solid) >= std::tie(undecided, undecided_in)) return;  // whatever is asked first
    undecided = where;
    undecided_in = of_solid;
  }
};

/// The ray must stay where it is.
class PartVisit {
 public:
  PartVisit() = default;
  explicit PartVisit(const Ray& r) : ray(&r) {}

  const Ray* ray = nullptr;
  PartHit best;
  std::vector<RayVisit>* visits = nullptr;  ///< of all parts, if there is one

  /// What lies behind it does not matter any more.
  double last() const { return std::min(ray->t_max, best.reached()); }

  /// What a part of the solid is told of the ray.
  ElementLog before(const Solid& solid) const {
    ElementLog log;
    log.visits = visits;
    if (outside_of_ == &solid) log.outside_from = outside_from_;
    return log;
  }

  /// Takes in only what a part of the solid said of the ray's beginning.
  void note_side(const Solid& solid, const ElementLog& log) {
    outside_of_ = &solid;
    outside_from_ = log.outside_from;
    best.begins_inside |= log.begins_inside;
  }

  /// Takes in what a part answered; t is infinity when it holds no hit. Whether `best` is a new hit.
  bool take(std::size_t index, const Solid& solid, const SolidPart& part, double t, const ElementLog& log) {
    note_side(solid, log);
    best.note_undecided(log.undecided, index);
    const double reached = std::max(t, log.enter);
    if (!(t < std::numeric_limits<double>::infinity()) || reached > best.reached()) return false;
    if (reached == best.reached() &&
        std::tuple(t, index, part.element, log.enter) > std::tuple(best.t, best.solid, best.element, best.enter))
      return false;
    best.t = t;
    best.solid = index;
    best.element = part.element;
    best.enter = log.enter;
    best.place = log.place;
    best.found = true;
    return true;
  }

 private:
  const Solid* outside_of_ = nullptr;
  double outside_from_ = std::numeric_limits<double>::infinity();  // ElementLog's, of that solid
};

}  // namespace marrow
