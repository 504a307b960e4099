// A ray on its way among others.
#pragma once

#include "renderer/geometry/nearest_parts.h"
#include "renderer/geometry/part_visit.h"

namespace marrow {

struct StreamedRay {
  explicit StreamedRay(const Ray& ray) : visit(ray) {}

  PartVisit visit;
  NearestParts ahead;
  bool finished = false;  ///< nothing more is to be asked, whatever lies ahead; of a ray for any hit: it has one

  /// Takes in what a part answered; `t` as in PartVisit.
  void take(std::size_t index, const Solid& solid, const SolidPart& part, double t, const ElementLog& log, bool any) {
    if (any) {
      visit.note_side(solid, log);
      visit.best.found |= t < std::numeric_limits<double>::infinity();
      finished |= visit.best.found;
    } else {
      visit.take(index, solid, part, t, log);
    }
    finished |= log.begins_inside;
  }
};

}  // namespace marrow
