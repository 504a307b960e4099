// Sixteen rays in one cell, from the ray as a double to where it meets the surface. Part of block_kernels_avx512.cpp:
// for other sets the compiler takes comparisons of vectors apart, and rays go one by one.
//
// Places and t are those of RayInCube and of BlendTracer's way for one ray, operation by operation.

using HalfIndex = int __attribute__((vector_size(32)));
using V8 = float __attribute__((vector_size(32)));
using V8d = double __attribute__((vector_size(64)));
using Mask8 = long long __attribute__((vector_size(64)));

inline constexpr int half_packet = 8;

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

inline Index16 mask_of(unsigned bits) {
  const Index16 bit{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  return (bit & static_cast<int>(bits)) != 0;
}

// What the search needs of the packet, in the coordinates of the block.
struct Packet {
  Ray16 ray;
  V16 t0, t1;
  unsigned from_surface = 0, from_outside = 0;
};

// Where the rays are in the cell; returns those that come into it.
inline unsigned enter_cell(const CellPlace& cell, const PacketView& rays, bool any_root, CellRoots& out) {
  unsigned entered = 0;
  for (int first = 0; first < lanes; first += half_packet) {
    const Entry8 entry(cell, Ray8(rays, first), any_root);
    store8(entry.stretch.enter, out.enter + first);
    store8(entry.stretch.exit, out.exit + first);
    entered |= entry.entered << first;
  }
  return entered;
}

inline Packet in_block(const CellPlace& cell, const PacketView& rays, const CellRoots& at) {
  alignas(64) float t0[lanes], t1[lanes], origin[3][lanes], direction[3][lanes];
  Packet packet;
  for (int first = 0; first < lanes; first += half_packet) {
    const Ray8 ray(rays, first);
    const Rays8InCube block(ray, cell.block_center, cell.block_half);
    const V8d enter = load8(at.enter + first);
    store8(block.to_local(enter), t0 + first);
    store8(block.to_local(load8(at.exit + first)), t1 + first);
    for (int k = 0; k < 3; ++k) {
      store8(block.origin[k], origin[k] + first);
      store8(block.direction[k], direction[k] + first);
    }
    packet.from_surface |= bits8(enter <= ray.t_min) << first;
    packet.from_outside |= bits8(enter >= load8(at.outside_from + first)) << first;
  }
  packet.t0 = load(t0);
  packet.t1 = load(t1);
  for (int k = 0; k < 3; ++k) {
    packet.ray.origin[k] = load(origin[k]);
    packet.ray.direction[k] = load(direction[k]);
  }
  return packet;
}

// The roots as places on the rays.
inline void leave_cell(const CellPlace& cell, const PacketView& rays, const RootOf<V16>& root, bool any_root,
                       CellRoots& out) {
  alignas(64) float t[lanes], undecided[lanes];
  __builtin_memcpy(t, &root.t, sizeof t);
  __builtin_memcpy(undecided, &root.undecided, sizeof undecided);
  unsigned in_time = 0;
  for (int first = 0; first < lanes; first += half_packet) {
    const Ray8 ray(rays, first);
    const Rays8InCube block(ray, cell.block_center, cell.block_half);
    const V8d exit = load8(out.exit + first), enter = load8(out.enter + first);
    V8d at = first_max(block.to_world(load8(t + first)), ray.t_min);
    if (any_root) at = first_min(at, exit);
    store8(at, out.t + first);
    store8(block.to_world(load8(undecided + first)), out.undecided + first);
    in_time |= bits8(at <= ray.t_max) << first;
    // Where the ray begins in this part, it begins outside.
    const V8d from = load8(out.outside_from + first), here = enter <= ray.t_min ? ray.t_min : exit;
    const Mask8 outside = __builtin_convertvector(
        *reinterpret_cast<const HalfIndex*>(reinterpret_cast<const char*>(&root.begins_outside) + 4 * first), Mask8);
    store8(outside ? first_min(from, here) : from, out.outside_from + first);
  }
  out.hit = out.met & in_time;
}

void roots_between(const BlockView& block, const CellPlace& cell, const PacketView& rays, unsigned asked, bool any_root,
                   PacketMemory& memory, CellRoots& out) {
  out.entered = asked;
  out.met = out.hit = out.begins_outside = out.enters_inside = 0;
  if (asked == 0) return;
  Packet packet = in_block(cell, rays, out);
  packet.ray.memory = &memory;
  const QueryOf<V16> query{
      packet.t0, packet.t1, any_root, false, mask_of(packet.from_surface), mask_of(packet.from_outside)};
  const RootOf<V16> root = block.find_patch != nullptr
                               ? first_root_of<Angle::Patched, V16>(block, packet.ray, query, mask_of(asked))
                               : first_root_of<Angle::One, V16>(block, packet.ray, query, mask_of(asked));
  __builtin_memcpy(out.evaluations, &root.evaluations, sizeof out.evaluations);
  out.met = lane_bits(root.hit);
  out.begins_outside = lane_bits(root.begins_outside);
  out.enters_inside = lane_bits(root.enters_inside);
  leave_cell(cell, rays, root, any_root, out);
}

void roots_in_cell(const BlockView& block, const CellPlace& cell, const PacketView& rays, unsigned asked, bool any_root,
                   PacketMemory& memory, CellRoots& out) {
  roots_between(block, cell, rays, asked & enter_cell(cell, rays, any_root, out), any_root, memory, out);
}
