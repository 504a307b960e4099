// From the objects of a scene to what rays can hit.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "field/base/result.h"
#include "renderer/geometry/surfaces.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

struct SurfaceOptions {
  std::string isa;  ///< "sse4", "avx2", "avx512"; empty: the best of this machine. Pictures do not depend on it.
  std::string embree_isa{};  ///< for the search of boxes alone, the same names; empty: that of `isa`
  int threads = 0;           ///< for building; 0: as many as the process may use
  /// What is otherwise made when the first ray needs it is made at once, as far as a lattice of rays meets it. Pictures
  /// do not depend on it.
  bool eager = false;
  /// How many samples of each pixel are wanted; 0: not known. For one alone space is divided less finely, for sixteen
  /// or more slots of large blends more finely, and pictures differ by rounding.
  int samples = 0;
};

struct SurfaceReport {
  std::size_t primitives = 0;  ///< skeleton primitives and triangles
  std::size_t tiles = 0;       ///< parts of space that may hold surface; rays divide them into cells
  std::size_t cells = 0;       ///< found so far
  std::size_t blocks = 0;      ///< cells that rays have entered so far
  std::size_t bytes = 0;
  double build_seconds = 0;
  double largest_error = 0;  ///< certified bound of the traced field's error in any block so far
};

/// Fields are traced by certified root finding in their cells, meshes and planes exactly; all in double precision.
/// Errors: fields that do not compile or cannot be traced, an unknown `isa`, an Embree failure.
Result<std::unique_ptr<Surfaces>> build_surfaces(const SceneDescription&, const SurfaceOptions&);

/// Of surfaces made by build_surfaces(); empty for others.
SurfaceReport report(const Surfaces&);

}  // namespace marrow
