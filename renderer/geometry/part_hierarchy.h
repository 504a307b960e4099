// The parts of solids under one Embree hierarchy.
//
// Embree only finds candidate boxes, in float, with the origin in the middle of them all; roots are found and compared
// in double. Its boxes are padded by 8 * 2^-24 * M, M the largest coordinate of boxes and ray origins from there, and
// by 2^-48 of the largest one in the scene, so that no rounding of the float traversal can lose a box, on any
// instruction set; ray origins are moved up to the boxes' bounds to keep M its own size.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/base/huge_pages.h"
#include "field/base/result.h"
#include "renderer/geometry/box_kernels.h"
#include "renderer/geometry/embree_handles.h"
#include "renderer/geometry/solid.h"
#include "renderer/geometry/streamed_ray.h"

namespace marrow {

/// Parts of one solid; it must outlive the hierarchy.
struct PartsOfSolid {
  const Solid* solid = nullptr;
  ObjectId object;
  std::pmr::vector<SolidPart> parts;  ///< in huge pages; of a hierarchy, padded for doubles (float_margin.h)
  Vec3d middle;                       ///< of all solids: Embree's origin
  double margin = 0;                  ///< by which Embree's boxes are padded beyond those of the parts

  PartsOfSolid(const Solid* s, ObjectId o, const std::vector<SolidPart>& of)
      : solid(s), object(o), parts(of.begin(), of.end(), &huge_pages()) {}
};

/// Safe to use from many threads.
class PartHierarchy {
 public:
  static Result<std::unique_ptr<PartHierarchy>> make(RTCDeviceTy* device, std::vector<PartsOfSolid> solids);

  using Hit = PartHit;
  /// The smallest t wins; at equal t the lower solid, the lower element, the part entered first: the order of traversal
  /// shows nowhere. `visits` grows, if there is one.
  Hit first_hit(const Ray&, std::vector<RayVisit>* visits = nullptr) const;
  /// `found`: something is in the way, of another object than `but`; the rest does not count, but `begins_inside`.
  Hit any_hit(const Ray&, ObjectId but = {}) const;

  static constexpr std::size_t most_together = RaysAmongBoxes::count;
  /// The nearest parts ahead of each of at most `most_together` rays; sooner when they are neighbours.
  void find_parts(std::span<StreamedRay* const>) const;
  /// Whether any solid traces packets: then it is worth taking rays together.
  bool traces_packets() const { return traces_packets_; }
  std::size_t part_count() const { return first_part_.back(); }
  /// Among all parts, from 0 on.
  std::uint32_t number_of(const PartEntry& entry) const { return first_part_[entry.solid()] + entry.part(); }
  const PartsOfSolid& solid(std::size_t index) const { return solids_[index]; }

 private:
  PartHierarchy(const BoxKernels&, std::vector<PartsOfSolid>);

  const BoxKernels& kernels_;
  std::vector<PartsOfSolid> solids_;
  std::vector<std::uint32_t> first_part_;  // the number of each solid's first part, and that of all
  bool traces_packets_ = false;
  Box3 padded_bounds_;  // what rays are clipped to
  Vec3d middle_;        // Embree's origin
  double margin_ = 0;   // that Embree's boxes are padded by
  EmbreeScene scene_;
};

}  // namespace marrow
