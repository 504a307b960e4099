// A packet of rays in their cells, from the ray as a double to where it meets the surface. Part of
// block_kernels_<set>.cpp.
//
// Places and t are those of RayInCube and of BlendTracer's way for one ray, operation by operation.

struct Stretches {
  Doubles enter, exit;
};

// As many rays of a packet as there are lanes of doubles.
struct SomeRays {
  Doubles origin[3], direction[3], t_min, t_max;

  SomeRays(const PacketView& p, int first) : t_min(load(p.t_min + first)), t_max(load(p.t_max + first)) {
    for (int k = 0; k < 3; ++k) {
      origin[k] = load(p.origin[k] + first);
      direction[k] = load(p.direction[k] + first);
    }
  }

  // clip() of ray_in_cube.h. `misses`: rays in a plane beside the box.
  Stretches in_box(const double (&lower)[3], const double (&upper)[3], DoubleMask& misses) const {
    Stretches s{t_min, Doubles{} + __builtin_inf()};
    misses = DoubleMask{};
    for (int k = 0; k < 3; ++k) {
      const Doubles inverse = 1 / direction[k];
      const DoubleMask parallel = (inverse == __builtin_inf()) | (inverse == -__builtin_inf());
      const Doubles a = (lower[k] - origin[k]) * inverse, b = (upper[k] - origin[k]) * inverse;
      s.enter = parallel ? s.enter : first_max(s.enter, first_min(a, b));
      s.exit = parallel ? s.exit : first_min(s.exit, first_max(a, b));
      misses |= parallel & ((origin[k] < lower[k]) | (origin[k] > upper[k]));
    }
    return s;
  }
};

// The same as RayInCube; in one cube, or each in its own.
template <class Size>
struct RaysInCube {
  Doubles t_near;
  Size half;
  Floats origin[3], direction[3];

  RaysInCube(const SomeRays& ray, const Size (&center)[3], Size cube_half) : half(cube_half) {
    Doubles toward[3];
    for (int k = 0; k < 3; ++k) toward[k] = center[k] - ray.origin[k];
    t_near = toward[0] * ray.direction[0] + toward[1] * ray.direction[1] + toward[2] * ray.direction[2];
    const Size scale = 1 / half;
    for (int k = 0; k < 3; ++k) {
      origin[k] = narrowed((ray.origin[k] - center[k] + ray.direction[k] * t_near) * scale);
      direction[k] = narrowed(ray.direction[k]);
    }
  }
  Floats to_local(Doubles t) const { return narrowed((t - t_near) / half); }
  Doubles to_world(Floats t) const { return t_near + widened(t) * half; }
};

// Where the rays are between the planes of layers of slots, of those in [begin, end].
inline void clip_to_layers(const TileLayers& tile, const RaysInCube<double>& cube, Floats& begin, Floats& end) {
  for (int k = 0; k < 3; ++k) {
    const Floats d = cube.direction[k], size = d < 0.0F ? -d : d;
    const Floats inverse = 1 / (size > 1e-20F ? d : Floats{} + 1e-20F);
    const Floats a = (tile.first_plane[k] - cube.origin[k]) * inverse,
                 b = (tile.end_plane[k] - cube.origin[k]) * inverse;
    begin = first_max(begin, first_min(a, b));
    end = first_min(end, first_max(a, b));
  }
}

// The same on their way into the cell.
struct Entry {
  Stretches stretch;
  unsigned entered;  // a bit for each ray

  Entry(const CellPlace& cell, const SomeRays& ray, bool any_root) {
    DoubleMask misses;
    stretch = ray.in_box(cell.box_lower, cell.box_upper, misses);
    if (any_root) stretch.exit = first_min(stretch.exit, ray.t_max + nearly_ended * cell.tiles[0].half);
    DoubleMask in = (stretch.enter < stretch.exit) & ~misses;
    for (int i = 0; i < cell.tile_count; ++i) in &= narrow(cell.tiles[i], ray);
    entered = bits_of_mask(in);
  }

  // Returns which rays come by.
  DoubleMask narrow(const TileLayers& tile, const SomeRays& ray) {
    const RaysInCube<double> cube(ray, tile.center, tile.half);
    const Floats first = cube.to_local(stretch.enter);
    Floats begin = first, end = cube.to_local(stretch.exit);
    clip_to_layers(tile, cube, begin, end);
    const Doubles from_layer = first_max(stretch.enter, cube.to_world(begin));
    stretch.enter = widened(begin) <= widened(first) ? stretch.enter : from_layer;
    stretch.exit = first_min(stretch.exit, cube.to_world(end));
    return widened(begin) < widened(end);
  }
};

// Where the rays are in the cell; returns those that come into it.
LaneSet enter_cell(const CellPlace& cell, const PacketView& rays, const LaneSet& asked, bool any_root, CellRoots& out) {
  LaneSet entered;
  asked.for_each_group<double_lanes>([&](int first) {
    const Entry entry(cell, SomeRays(rays, first), any_root);
    const unsigned together = asked.group<double_lanes>(first);
    const DoubleMask here = double_mask(together);  // their neighbours may be in other cells
    store(here ? entry.stretch.enter : load(out.enter + first), out.enter + first);
    store(here ? entry.stretch.exit : load(out.exit + first), out.exit + first);
    entered.add_group(first, entry.entered & together);
  });
  return entered;
}

// The blocks of the rays.
struct Frames {
  alignas(64) double center[3][packet_size], half[packet_size];

  void set(int ray, const CellRays& cell) {
    for (int k = 0; k < 3; ++k) center[k][ray] = cell.center[k];
    half[ray] = cell.half;
  }
  RaysInCube<Doubles> of(const SomeRays& rays, int first) const {
    return {rays, {load(center[0] + first), load(center[1] + first), load(center[2] + first)}, load(half + first)};
  }
};

// The rays in the coordinates of their blocks.
inline void enter_blocks(const Frames& frames, const PacketView& rays, const LaneSet& asked, const CellRoots& at,
                         BlockRays& out) {
  LaneSet from_surface, from_outside;
  asked.for_each_group<double_lanes>([&](int first) {
    const SomeRays ray(rays, first);
    const RaysInCube<Doubles> block = frames.of(ray, first);
    const Doubles enter = load(at.enter + first);
    store(block.to_local(enter), out.from + first);
    store(block.to_local(load(at.exit + first)), out.to + first);
    for (int k = 0; k < 3; ++k) {
      store(block.origin[k], out.origin[k] + first);
      store(block.direction[k], out.direction[k] + first);
    }
    from_surface.add_group(first, bits_of_mask(enter <= ray.t_min));
    from_outside.add_group(first, bits_of_mask(enter >= load(at.outside_from + first)));
  });
  out.from_surface = from_surface & asked;
  out.from_surface.for_each([&](int ray) { out.around[ray] = rays.around[ray]; });
  out.begins_outside = from_outside & asked;
}

// The roots as places on the rays.
inline void leave_blocks(const Frames& frames, const PacketView& rays, const LaneSet& asked, const BlockRays& roots,
                         bool any_root, CellRoots& out) {
  LaneSet in_time;
  asked.for_each_group<double_lanes>([&](int first) {
    const SomeRays ray(rays, first);
    const RaysInCube<Doubles> block = frames.of(ray, first);
    const Doubles exit = load(out.exit + first), enter = load(out.enter + first);
    // By rounding a place in the block may come before it is entered: then another cell may hold the hit, too, and
    // which of them counts must not depend on where the ray ends.
    Doubles at = first_max(block.to_world(load_floats(roots.t + first)), enter);
    if (any_root) at = at > ray.t_max - nearly_ended * block.half ? ray.t_max : at;
    store(at, out.t + first);
    store(block.to_world(load_floats(roots.undecided + first)), out.undecided + first);
    store(block.to_world(load_floats(roots.searched_from + first)), out.searched_from + first);
    in_time.add_group(first, bits_of_mask(at <= ray.t_max));
    // Where the ray begins in this part, it begins outside.
    const Doubles from = load(out.outside_from + first), here = enter <= ray.t_min ? ray.t_min : exit;
    store(double_mask(roots.begins_outside.group<double_lanes>(first)) ? first_min(from, here) : from,
          out.outside_from + first);
  });
  __builtin_memcpy(out.evaluations, roots.evaluations, sizeof out.evaluations);
  out.met = roots.hit;
  out.hit = roots.hit & in_time;
  out.begins_outside = roots.begins_outside;
  out.enters_inside = roots.enters_inside;
}

void roots_between(const CellRays* cells, int count, const PacketView& rays, bool any_root, PacketMemory& memory,
                   CellRoots& out) {
  BlockRays& in_blocks = *reinterpret_cast<BlockRays*>(memory.rays);
  Frames frames;
  __builtin_memset(in_blocks.cell, 0, sizeof in_blocks.cell);
  LaneSet asked;
  for (int i = 0; i < count; ++i) {
    asked |= cells[i].rays;
    cells[i].rays.for_each([&](int ray) {
      in_blocks.cell[ray] = i;
      frames.set(ray, cells[i]);
    });
  }
  out.entered = asked;
  out.met = out.hit = out.begins_outside = out.enters_inside = {};
  if (asked.empty()) return;
  enter_blocks(frames, rays, asked, out, in_blocks);
  if (cells[0].block->parts != nullptr) BlockSearch<Angle::Patched>(cells, count, any_root, memory).run(asked);
  else BlockSearch<Angle::One>(cells, count, any_root, memory).run(asked);
  leave_blocks(frames, rays, asked, in_blocks, any_root, out);
}
