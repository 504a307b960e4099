// All kernels, and the table of those that the tracer calls. Part of block_kernels_<set>.cpp: each compiles this text
// for its instruction set.

// In this order: each builds on those before.
// clang-format off
#include "field/trace/kernels/lanes/native.h"
#include "field/trace/kernels/lanes/doubles.h"
#include "field/trace/kernels/lanes/sixteen.h"
#include "field/trace/kernels/lanes/lanes.h"
#include "field/trace/kernels/lanes/packet_values.h"
#include "field/trace/kernels/lanes/per_ray.h"
#include "field/trace/kernels/lanes/vec3.h"
#include "field/trace/kernels/sums/sources.h"
#include "field/trace/kernels/sums/ray_sums.h"
#include "field/trace/kernels/angles/angle_sums.h"
#include "field/trace/kernels/sums/full_sums.h"
#include "field/trace/kernels/sums/levels.h"
#include "field/trace/kernels/sums/far_on_ray.h"
#include "field/trace/kernels/sums/sums_in_rays.h"
#include "field/trace/kernels/sums/packet_sums.h"
#include "field/trace/kernels/search/iso.h"
#include "field/trace/kernels/angles/strands.h"
#include "field/trace/kernels/angles/strand_turns.h"
#include "field/trace/kernels/angles/strand_shares.h"
#include "field/trace/kernels/angles/strand_samples.h"
#include "field/trace/kernels/angles/angle_place.h"
#include "field/trace/kernels/angles/share_patch.h"
#include "field/trace/kernels/search/sample.h"
#include "field/trace/kernels/angles/varied_angle.h"
#include "field/trace/kernels/angles/patched_angle.h"
#include "field/trace/kernels/search/sampler.h"
#include "field/trace/kernels/search/march.h"
#include "field/trace/kernels/search/search.h"
#include "field/trace/kernels/search/approach.h"
#include "field/trace/kernels/search/layers.h"
#include "field/trace/kernels/search/slot_bits.h"
#include "field/trace/kernels/search/runs.h"
#include "field/trace/kernels/search/departure.h"
#include "field/trace/kernels/search/first_root.h"
#include "field/trace/kernels/packet/packet_lanes.h"
#include "field/trace/kernels/packet/packet_levels.h"
#include "field/trace/kernels/packet/packet_ahead.h"
#include "field/trace/kernels/packet/packet_runs.h"
#include "field/trace/kernels/packet/block_search.h"
#include "field/trace/kernels/packet/packet.h"
#include "field/trace/kernels/search/walk.h"
#include "field/trace/kernels/search/points.h"
#include "field/trace/kernels/search/surface_starts.h"
#include "field/trace/kernels/sums/nodes.h"
#include "field/trace/kernels/sums/cube.h"
#include "field/trace/kernels/sums/moments.h"
#include "field/trace/kernels/sums/split.h"
// clang-format on

constexpr BlockKernels all_kernels{first_root,     enter_cell, roots_between, point_fields,  surface_starts,
                                   place_margins,  walk,       write_nodes,   cube_bounds,   octant_cube_bounds,
                                   far_moments,    far_split,  octant_bounds, strand_shares, strand_in_middle,
                                   strand_samples, add_strand};
