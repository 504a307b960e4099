// All kernels, and the table of those that the tracer calls. Part of block_kernels_<set>.cpp: each compiles this text
// for its instruction set.

// In this order: each builds on those before.
// clang-format off
#include "field/trace/kernels/native.h"
#include "field/trace/kernels/doubles.h"
#include "field/trace/kernels/sixteen.h"
#include "field/trace/kernels/lanes.h"
#include "field/trace/kernels/packet_values.h"
#include "field/trace/kernels/per_ray.h"
#include "field/trace/kernels/vec3.h"
#include "field/trace/kernels/sources.h"
#include "field/trace/kernels/ray_sums.h"
#include "field/trace/kernels/angle_sums.h"
#include "field/trace/kernels/full_sums.h"
#include "field/trace/kernels/levels.h"
#include "field/trace/kernels/far_on_ray.h"
#include "field/trace/kernels/sums_in_rays.h"
#include "field/trace/kernels/packet_sums.h"
#include "field/trace/kernels/iso.h"
#include "field/trace/kernels/strands.h"
#include "field/trace/kernels/strand_samples.h"
#include "field/trace/kernels/angle_place.h"
#include "field/trace/kernels/share_patch.h"
#include "field/trace/kernels/sample.h"
#include "field/trace/kernels/varied_angle.h"
#include "field/trace/kernels/patched_angle.h"
#include "field/trace/kernels/sampler.h"
#include "field/trace/kernels/march.h"
#include "field/trace/kernels/search.h"
#include "field/trace/kernels/approach.h"
#include "field/trace/kernels/layers.h"
#include "field/trace/kernels/slot_bits.h"
#include "field/trace/kernels/runs.h"
#include "field/trace/kernels/departure.h"
#include "field/trace/kernels/first_root.h"
#include "field/trace/kernels/packet_lanes.h"
#include "field/trace/kernels/packet_levels.h"
#include "field/trace/kernels/packet_ahead.h"
#include "field/trace/kernels/packet_runs.h"
#include "field/trace/kernels/block_search.h"
#include "field/trace/kernels/packet.h"
#include "field/trace/kernels/walk.h"
#include "field/trace/kernels/points.h"
#include "field/trace/kernels/surface_starts.h"
#include "field/trace/kernels/nodes.h"
#include "field/trace/kernels/cube.h"
#include "field/trace/kernels/moments.h"
#include "field/trace/kernels/split.h"
// clang-format on

constexpr BlockKernels all_kernels{first_root,     enter_cell, roots_between, point_fields,  surface_starts,
                                   place_margins,  walk,       write_nodes,   cube_bounds,   octant_cube_bounds,
                                   far_moments,    far_split,  octant_bounds, strand_shares, strand_in_middle,
                                   strand_samples, add_strand};
