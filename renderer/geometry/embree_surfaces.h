// Solids under one Embree hierarchy, and infinite planes beside it.
//
// Embree only finds candidate boxes, in float; roots are found and compared in double. Boxes are padded by
// 8 * 2^-24 * M, M the largest coordinate of boxes and ray origins, so that no rounding of the float traversal can
// lose a box, on any instruction set; ray origins are moved up to the scene's bounds to keep M its own size.
#pragma once

#include <memory>
#include <vector>

#include "field/base/result.h"
#include "renderer/geometry/embree_handles.h"
#include "renderer/geometry/solid.h"
#include "renderer/geometry/surfaces.h"

namespace marrow {

struct PlacedSolid {
  std::unique_ptr<Solid> solid;
  ObjectId object;
  double padding = 0;  ///< of the boxes of its elements; set by EmbreeSurfaces
};

struct PlacedPlane {
  Vec3d point;
  UnitVec3 normal;
  MaterialId material;
  ObjectId object;
};

class EmbreeSurfaces final : public Surfaces {
 public:
  /// `config` is Embree's device string, e.g. "threads=2,isa=avx2".
  static Result<std::unique_ptr<EmbreeSurfaces>> make(std::vector<PlacedSolid>, std::vector<PlacedPlane>,
                                                      const std::string& config);

  using Surfaces::first_hit;
  std::optional<SurfaceHit> first_hit(const Ray&, RayRecord&) const override;
  bool occluded(const Ray&) const override;
  Box3 bounds() const override { return extent_; }

  const std::vector<PlacedSolid>& solids() const { return solids_; }
  double build_seconds = 0;

 private:
  EmbreeSurfaces(std::vector<PlacedSolid> solids, std::vector<PlacedPlane> planes)
      : solids_(std::move(solids)), planes_(std::move(planes)) {}
  const PlacedPlane* nearest_plane(const Ray&, double& t) const;

  std::vector<PlacedSolid> solids_;
  std::vector<PlacedPlane> planes_;
  Box3 extent_;         // of all solids
  Box3 padded_bounds_;  // what rays are clipped to
  EmbreeDevice device_;
  EmbreeScene scene_;
};

}  // namespace marrow
