// The surface as triangles: what a renderer that polygonises would trace.
#pragma once

#include "field/base/result.h"
#include "field/math/box3.h"
#include "renderer/bench/ray_engine.h"
#include "renderer/bench/stop_request.h"
#include "renderer/geometry/surfaces.h"

namespace marrow {

/// A dual mesh on a grid of the given spacing: one vertex in each cube that the surface crosses, the mean of its
/// crossings with the cube's edges; these are roots that the tracer found, so the mesh has its exactness at the edges.
/// [Gibson 1998, surface nets] Hollows that no path along grid edges reaches from outside are left out, and so are
/// sheets thinner than an edge. When asked to stop it is a part of the mesh. Error: a spacing below
/// finest_mesh_spacing() of the surfaces' bounds.
Result<TriangleMesh> dual_mesh(const Surfaces&, double spacing, StopRequest stop = {});

/// The finest grid that dual_mesh() takes: with 2^29 corners, which are some gigabytes. Rounded up to two digits.
double finest_mesh_spacing(const Box3& bounds);

}  // namespace marrow
