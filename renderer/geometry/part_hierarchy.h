// The parts of solids under one Embree hierarchy.
//
// Embree only finds candidate boxes, in float; roots are found and compared in double. Boxes are padded by
// 8 * 2^-24 * M, M the largest coordinate of boxes and ray origins, so that no rounding of the float traversal can
// lose a box, on any instruction set; ray origins are moved up to the boxes' bounds to keep M its own size.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "field/base/result.h"
#include "renderer/geometry/embree_handles.h"
#include "renderer/geometry/part_visit.h"
#include "renderer/geometry/solid.h"

namespace marrow {

/// Parts of one solid; it must outlive the hierarchy.
struct PartsOfSolid {
  const Solid* solid = nullptr;
  std::vector<SolidPart> parts;
};

/// Safe to use from many threads.
class PartHierarchy {
 public:
  static Result<std::unique_ptr<PartHierarchy>> make(RTCDeviceTy* device, std::vector<PartsOfSolid> solids);

  using Hit = PartHit;
  using Hits = std::array<Hit, RayPacket::size>;
  /// The smallest t wins; at equal t the lower solid, the lower element, the part entered first: the order of traversal
  /// shows nowhere. `logs`, if any, is told of all parts visited.
  Hit first_hit(const Ray&, std::vector<ElementLog>* logs) const;
  bool occluded(const Ray&) const;
  using Logs = std::array<std::vector<ElementLog>, RayPacket::size>;
  /// The same for the rays of `lanes` (bit i is lane i), to the same bits; `hits` of other lanes are left as they are.
  void first_hits(const RayPacket&, unsigned lanes, Hits& hits, Logs* logs = nullptr) const;
  /// Those of `lanes` that are occluded.
  unsigned occluded(const RayPacket&, unsigned lanes) const;
  std::size_t part_count() const;

 private:
  explicit PartHierarchy(std::vector<PartsOfSolid> solids) : solids_(std::move(solids)) {}

  std::vector<PartsOfSolid> solids_;
  Box3 padded_bounds_;  // what rays are clipped to
  EmbreeScene scene_;
};

}  // namespace marrow
