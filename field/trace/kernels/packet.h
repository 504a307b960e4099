// A packet of rays in one cell, from the ray as a double to where it meets the surface. Part of
// block_kernels_avx512.cpp: for other sets the compiler takes comparisons of vectors apart, and rays go one by one.
//
// Places and t are those of RayInCube and of BlendTracer's way for one ray, operation by operation.

using HalfIndex = int __attribute__((vector_size(32)));
using V8 = float __attribute__((vector_size(32)));
using V8d = double __attribute__((vector_size(64)));
using Mask8 = long long __attribute__((vector_size(64)));

inline constexpr int octet = 8;

inline V8d splat8(double s) { return V8d{} + s; }
inline V8d load8(const double* p) { return *static_cast<const V8d*>(__builtin_assume_aligned(p, 64)); }
inline void store8(V8d v, double* p) { *static_cast<V8d*>(__builtin_assume_aligned(p, 64)) = v; }
inline void store8(V8 v, float* p) { *static_cast<V8*>(__builtin_assume_aligned(p, 32)) = v; }
inline V8 load8(const float* p) { return *static_cast<const V8*>(__builtin_assume_aligned(p, 32)); }
// Which of two equal or unordered ones is returned is as with std::min and std::max.
inline V8d first_min(V8d a, V8d b) { return b < a ? b : a; }
inline V8d first_max(V8d a, V8d b) { return a < b ? b : a; }
inline V8 first_min(V8 a, V8 b) { return b < a ? b : a; }
inline V8 first_max(V8 a, V8 b) { return a < b ? b : a; }
inline V8 narrowed(V8d v) { return __builtin_convertvector(v, V8); }
inline V8d widened(V8 v) { return __builtin_convertvector(v, V8d); }
inline Mask8 mask8(std::uint64_t bits) {
  const Mask8 bit{1, 2, 4, 8, 16, 32, 64, 128};
  return (bit & static_cast<long long>(bits & 0xff)) != 0;
}
inline unsigned bits8(Mask8 mask) { return static_cast<unsigned>(__builtin_ia32_cvtq2mask512(mask)) & 0xffU; }

struct Stretch8 {
  V8d enter, exit;
};

// Eight rays of a packet.
struct Ray8 {
  V8d origin[3], direction[3], t_min, t_max;

  Ray8(const PacketView& p, int first) : t_min(load8(p.t_min + first)), t_max(load8(p.t_max + first)) {
    for (int k = 0; k < 3; ++k) {
      origin[k] = load8(p.origin[k] + first);
      direction[k] = load8(p.direction[k] + first);
    }
  }

  // clip() of ray_in_cube.h. `misses`: rays in a plane beside the box.
  Stretch8 in_box(const double (&lower)[3], const double (&upper)[3], Mask8& misses) const {
    Stretch8 s{t_min, splat8(__builtin_inf())};
    misses = Mask8{};
    for (int k = 0; k < 3; ++k) {
      const V8d inverse = 1 / direction[k];
      const Mask8 parallel = (inverse == __builtin_inf()) | (inverse == -__builtin_inf());
      const V8d a = (lower[k] - origin[k]) * inverse, b = (upper[k] - origin[k]) * inverse;
      s.enter = parallel ? s.enter : first_max(s.enter, first_min(a, b));
      s.exit = parallel ? s.exit : first_min(s.exit, first_max(a, b));
      misses |= parallel & ((origin[k] < lower[k]) | (origin[k] > upper[k]));
    }
    return s;
  }
};

// Eight rays as RayInCube.
struct Rays8InCube {
  V8d t_near;
  double half;
  V8 origin[3], direction[3];

  Rays8InCube(const Ray8& ray, const double (&center)[3], double cube_half) : half(cube_half) {
    V8d toward[3];
    for (int k = 0; k < 3; ++k) toward[k] = center[k] - ray.origin[k];
    t_near = toward[0] * ray.direction[0] + toward[1] * ray.direction[1] + toward[2] * ray.direction[2];
    const double scale = 1 / half;
    for (int k = 0; k < 3; ++k) {
      origin[k] = narrowed((ray.origin[k] - center[k] + ray.direction[k] * t_near) * scale);
      direction[k] = narrowed(ray.direction[k]);
    }
  }
  V8 to_local(V8d t) const { return narrowed((t - t_near) / half); }
  V8d to_world(V8 t) const { return t_near + widened(t) * half; }
};

// Where the rays are between the planes of layers of slots, of those in [begin, end].
inline void clip_to_layers(const TileLayers& tile, const Rays8InCube& cube, V8& begin, V8& end) {
  for (int k = 0; k < 3; ++k) {
    const V8 d = cube.direction[k], size = d < 0.0F ? -d : d;
    const V8 inverse = 1 / (size > 1e-20F ? d : V8{} + 1e-20F);
    const V8 a = (tile.first_plane[k] - cube.origin[k]) * inverse, b = (tile.end_plane[k] - cube.origin[k]) * inverse;
    begin = first_max(begin, first_min(a, b));
    end = first_min(end, first_max(a, b));
  }
}

// Eight rays on their way into the cell.
struct Entry8 {
  Stretch8 stretch;
  unsigned entered;  // a bit for each ray

  Entry8(const CellPlace& cell, const Ray8& ray, bool any_root) {
    Mask8 misses;
    stretch = ray.in_box(cell.box_lower, cell.box_upper, misses);
    if (any_root) stretch.exit = first_min(stretch.exit, ray.t_max);
    Mask8 in = (stretch.enter < stretch.exit) & ~misses;
    for (int i = 0; i < cell.tile_count; ++i) in &= narrow(cell.tiles[i], ray);
    entered = bits8(in);
  }

  // Returns which rays come by.
  Mask8 narrow(const TileLayers& tile, const Ray8& ray) {
    const Rays8InCube cube(ray, tile.center, tile.half);
    const V8 first = cube.to_local(stretch.enter);
    V8 begin = first, end = cube.to_local(stretch.exit);
    clip_to_layers(tile, cube, begin, end);
    const V8d from_layer = first_max(stretch.enter, cube.to_world(begin));
    stretch.enter = widened(begin) <= widened(first) ? stretch.enter : from_layer;
    stretch.exit = first_min(stretch.exit, cube.to_world(end));
    return widened(begin) < widened(end);
  }
};

// Calls visit(first) for each eight lanes, from a multiple of eight on, of which any is in the set.
template <class Visit>
inline void for_each_octet(std::uint64_t rays, const Visit& visit) {
  for (int first = 0; first < packet_size; first += octet)
    if (rays >> first & 0xff) visit(first);
}

// Where the rays are in the cell; returns those that come into it.
inline std::uint64_t enter_cell(const CellPlace& cell, const PacketView& rays, std::uint64_t asked, bool any_root,
                                CellRoots& out) {
  std::uint64_t entered = 0;
  for_each_octet(asked, [&](int first) {
    const Entry8 entry(cell, Ray8(rays, first), any_root);
    store8(entry.stretch.enter, out.enter + first);
    store8(entry.stretch.exit, out.exit + first);
    entered |= static_cast<std::uint64_t>(entry.entered) << first;
  });
  return entered;
}

// The rays in the coordinates of the block.
inline void enter_block(const CellPlace& cell, const PacketView& rays, std::uint64_t asked, const CellRoots& at,
                        BlockRays& out) {
  std::uint64_t from_surface = 0, from_outside = 0;
  for_each_octet(asked, [&](int first) {
    const Ray8 ray(rays, first);
    const Rays8InCube block(ray, cell.block_center, cell.block_half);
    const V8d enter = load8(at.enter + first);
    store8(block.to_local(enter), out.from + first);
    store8(block.to_local(load8(at.exit + first)), out.to + first);
    for (int k = 0; k < 3; ++k) {
      store8(block.origin[k], out.origin[k] + first);
      store8(block.direction[k], out.direction[k] + first);
    }
    from_surface |= static_cast<std::uint64_t>(bits8(enter <= ray.t_min)) << first;
    from_outside |= static_cast<std::uint64_t>(bits8(enter >= load8(at.outside_from + first))) << first;
  });
  out.from_surface = from_surface & asked;
  out.begins_outside = from_outside & asked;
}

// The roots as places on the rays.
inline void leave_block(const CellPlace& cell, const PacketView& rays, std::uint64_t asked, const BlockRays& roots,
                        bool any_root, CellRoots& out) {
  std::uint64_t in_time = 0;
  for_each_octet(asked, [&](int first) {
    const Ray8 ray(rays, first);
    const Rays8InCube block(ray, cell.block_center, cell.block_half);
    const V8d exit = load8(out.exit + first), enter = load8(out.enter + first);
    V8d at = first_max(block.to_world(load8(roots.t + first)), ray.t_min);
    if (any_root) at = first_min(at, exit);
    store8(at, out.t + first);
    store8(block.to_world(load8(roots.undecided + first)), out.undecided + first);
    store8(block.to_world(load8(roots.searched_from + first)), out.searched_from + first);
    in_time |= static_cast<std::uint64_t>(bits8(at <= ray.t_max)) << first;
    // Where the ray begins in this part, it begins outside.
    const V8d from = load8(out.outside_from + first), here = enter <= ray.t_min ? ray.t_min : exit;
    store8(mask8(roots.begins_outside >> first) ? first_min(from, here) : from, out.outside_from + first);
  });
  __builtin_memcpy(out.evaluations, roots.evaluations, sizeof out.evaluations);
  out.met = roots.hit;
  out.hit = roots.hit & in_time;
  out.begins_outside = roots.begins_outside;
  out.enters_inside = roots.enters_inside;
}

void roots_between(const BlockView& block, const CellPlace& cell, const PacketView& rays, std::uint64_t asked,
                   bool any_root, PacketMemory& memory, CellRoots& out) {
  out.entered = asked;
  out.met = out.hit = out.begins_outside = out.enters_inside = 0;
  if (asked == 0) return;
  BlockRays& in_block = *reinterpret_cast<BlockRays*>(memory.rays);
  enter_block(cell, rays, asked, out, in_block);
  if (block.find_patch != nullptr) BlockSearch<Angle::Patched>(block, any_root, memory).run(asked);
  else BlockSearch<Angle::One>(block, any_root, memory).run(asked);
  leave_block(cell, rays, asked, in_block, any_root, out);
}

void roots_in_cell(const BlockView& block, const CellPlace& cell, const PacketView& rays, std::uint64_t asked,
                   bool any_root, PacketMemory& memory, CellRoots& out) {
  const std::uint64_t entered = asked & enter_cell(cell, rays, asked, any_root, out);
  roots_between(block, cell, rays, entered, any_root, memory, out);
}
