// The share of the range of angles on a ray, where directions give it: a polynomial for each part of a block
// (share_patches.h). Part of block_kernels_<set>.cpp.

// A polynomial in the way from a place on the ray.
template <int Degree, class F>
struct OnWay {
  F c[Degree + 1];
};
// A coordinate on that way.
template <class F>
struct WayLine {
  F at, slope;
};

template <class F>
inline OnWay<1, F> operator*(F a, const WayLine<F>& x) {
  return {{a * x.at, a * x.slope}};
}
template <int Degree, class F>
inline OnWay<Degree + 1, F> operator*(const OnWay<Degree, F>& p, const WayLine<F>& x) {
  OnWay<Degree + 1, F> r;
  r.c[0] = p.c[0] * x.at;
  for (int i = 1; i <= Degree; ++i) r.c[i] = p.c[i] * x.at + p.c[i - 1] * x.slope;
  r.c[Degree + 1] = p.c[Degree] * x.slope;
  return r;
}
template <int Degree, class F>
inline OnWay<Degree, F> operator+(OnWay<Degree, F> p, F a) {
  p.c[0] += a;
  return p;
}
template <int Degree, class F>
inline OnWay<Degree, F> operator+(OnWay<Degree, F> p, const OnWay<Degree, F>& q) {
  for (int i = 0; i <= Degree; ++i) p.c[i] += q.c[i];
  return p;
}

// The layer of a coordinate, of so many in a block.
template <int Count = 8, class F>
inline IntOf<F> layer_of(F x) {
  constexpr float half = 0.5F * Count, last = Count - 0.5F;
  return whole_part(max_of(0.0F, min_of(x * half + half, last)));
}

// The path to a smallest part: from the largest cube to the smallest the octants that hold it, x the lowest bit of
// each.
template <class Int>
inline Int path_to(const Int (&layer)[3]) {
  static_assert(SharePart::halvings <= 8);
  // Two bits come between those of a layer: halves of eight move apart, then halves of those.
  const auto spread = [](Int bits) {
    bits = (bits | bits << 8) & 0xf00f;
    bits = (bits | bits << 4) & 0xc30c3;
    return (bits | bits << 2) & 0x249249;
  };
  return spread(layer[0]) | spread(layer[1]) << 1 | spread(layer[2]) << 2;
}

// Asks memory for all eight parts: rays that come to one of them soon come to others.
inline void ask_for_eight(const SharePart* parts) {
  for (int octant = 0; octant < 8; octant += 2) __builtin_prefetch(parts + octant);
}

// That holds a smallest part of the block; made where it is asked for first.
inline const SharePart& part_at(const BlockView& block, int path) {
  const SharePart* parts = block.parts;
  for (int shift = SharePart::root_shift;; shift -= 3) {
    const SharePart& part = parts[path >> shift & 7];
    const std::uintptr_t address = __atomic_load_n(&part.address, __ATOMIC_ACQUIRE);
    if (address == 0) return block.make_part(block.owner, path);
    if ((address & SharePart::divided) == 0) return part;
    parts = reinterpret_cast<const SharePart*>(address - SharePart::divided);
    ask_for_eight(parts);
  }
}
inline const SharePatch& patch_at(const BlockView& block, int path) {
  return *reinterpret_cast<const SharePatch*>(part_at(block, path).address);
}

// What runs need of parts.
template <class F>
struct PartLines {
  F half, level, slope[3], bent;
};
inline PartLines<float> lines_at(const BlocksOf<float>& blocks, bool, int path) {
  const SharePart& part = part_at(*blocks.block, path);
  return {part.half, part.level, {part.slope[0], part.slope[1], part.slope[2]}, part.bent};
}
inline PartLines<PacketFloat> lines_at(const BlocksOf<PacketFloat>& blocks, PacketMask rays, PacketInt path) {
  static constexpr SharePart none{};
  const SharePart* parts[packet_lanes];
  for (const SharePart*& part : parts) part = &none;
  for (unsigned left = rays.bits(); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    parts[lane] = &part_at(blocks.of(lane), path[lane]);
  }
  static_assert(sizeof(SharePart) == 8 * sizeof(float) && sizeof(none.address) == 2 * sizeof(float));
  const auto [low, high] = eight_of_lanes([&](int lane) { return reinterpret_cast<const float*>(parts[lane]); });
  return {low[2], low[3], {high[0], high[1], high[2]}, high[3]};
}

// Where a ray leaves a part of the block by more than places are rounded.
template <class F>
inline F leave_part(const RayOf<F>& ray, const F (&center)[3], F half) {
  constexpr float clearly = 1e-6F, outermost = 1 - clearly;
  F end = all_lanes<F>(infinity);
  for (int k = 0; k < 3; ++k) {
    const F d = nonzero(ray.direction[k]), face = center[k] + select(d > 0.0F, half, -half);
    // The outer ones go on beyond the block.
    const F leave = (face + select(d > 0.0F, all_lanes<F>(clearly), all_lanes<F>(-clearly)) - ray.origin[k]) / d;
    end = min_of(end, select(abs_of(face) < outermost, leave, all_lanes<F>(infinity)));
  }
  return end;
}

// The part in which a ray is at t, until it leaves that.
template <class F>
struct LineOfPart {
  F at, slope, bent, exit;

  LineOfPart(const BlocksOf<F>& blocks, const RayOf<F>& ray, F t, MaskOf<F> rays) {
    IntOf<F> layer[3];
    for (int k = 0; k < 3; ++k) layer[k] = layer_of<SharePart::layers>(ray.origin[k] + ray.direction[k] * t);
    const PartLines<F> part = lines_at(blocks, rays, path_to(layer));
    constexpr float of_block = SharePart::layers;
    const IntOf<F> layers = whole_part(part.half * of_block);
    at = part.level;
    slope = F{};
    bent = part.bent;
    F center[3];
    for (int k = 0; k < 3; ++k) {
      center[k] = (to_float(layer[k] & -layers) * (2 / of_block) + part.half) - 1.0F;
      at += part.slope[k] * (ray.origin[k] - center[k]);
      slope += part.slope[k] * ray.direction[k];
    }
    exit = leave_part(ray, center, part.half);
  }
};

// The share on a stretch of a ray: on a line in t, but for what lies between two numbers.
template <class F>
struct ShareLine {
  F at{}, slope{};
  F low{}, high{};

  // Holds that of a part from `begin` to `end`, too.
  void widen(MaskOf<F> rays, const LineOfPart<F>& part, F begin, F end) {
    const F beside = part.at - at, turned = part.slope - slope, a = beside + turned * begin, b = beside + turned * end;
    assign(rays, low, min_of(low, min_of(a, b) - part.bent));
    assign(rays, high, max_of(high, max_of(a, b) + part.bent));
  }
};
inline void assign(PacketMask mask, ShareLine<PacketFloat>& to, const ShareLine<PacketFloat>& from) {
  using Line = ShareLine<PacketFloat>;
  for (PacketFloat Line::*part : {&Line::at, &Line::slope, &Line::low, &Line::high}) assign(mask, to.*part, from.*part);
}

// From part to part on a run; what is clipped off a corner goes with its neighbours, which differ by less than a share
// does over that. A ray that does not leave a part where it should, along a face, is looked for a little later.
template <class F>
inline ShareLine<F> line_on(const BlocksOf<F>& blocks, const RayOf<F>& ray, MaskOf<F> rays, F begin, F end) {
  constexpr float corner = 1e-5F, little = 1.0F / 32;
  ShareLine<F> line;
  MaskOf<F> first = rays;
  F t = begin;
  for (MaskOf<F> open = rays; any(open); first = MaskOf<F>{}) {
    const LineOfPart<F> part(blocks, ray, t + corner, open);
    assign(first, line, {part.at, part.slope, -part.bent, part.bent});
    const F left = select(part.exit > t, part.exit, t + little);
    line.widen(open & !first, part, t, min_of(left, end));
    t = left;
    open = open & (t + corner < end);
  }
  return line;
}

// The parts in which rays are.
template <class F>
struct Patches;

template <>
struct Patches<float> {
  const SharePatch* patch = nullptr;

  void find(const BlocksOf<float>& blocks, bool ray, const int (&layer)[3]) {
    if (ray) patch = &patch_at(*blocks.block, path_to(layer));
  }
  float coefficient(int i) const { return patch->coefficient[i]; }
  float center(int k) const { return patch->center[k]; }
  float inverse_half() const { return patch->inverse_half; }
};

template <>
struct Patches<PacketFloat> {
  PacketFloat column[floats_per_patch];  // what the patches hold, a ray in each lane

  void find(const BlocksOf<PacketFloat>& blocks, PacketMask rays, const PacketInt (&layer)[3]) {
    static constexpr SharePatch none{};
    const SharePatch* patch[packet_lanes];
    for (const SharePatch*& p : patch) p = &none;
    const PacketInt path = path_to(layer);
    for (unsigned left = rays.bits(); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      patch[lane] = &patch_at(blocks.of(lane), path[lane]);
    }
    for (int part = 0; part < floats_per_patch; part += lanes) {
      V16 rows[packet_lanes];
      for (int lane = 0; lane < packet_lanes; ++lane)
        __builtin_memcpy(&rows[lane], reinterpret_cast<const char*>(patch[lane]) + part * sizeof(float), sizeof(V16));
      PacketFloat columns[lanes];
      find_columns(rows, columns);
      for (int i = 0; i < lanes; ++i) column[part + i] = columns[i];
    }
  }
  PacketFloat coefficient(int i) const { return column[number(__builtin_offsetof(SharePatch, coefficient)) + i]; }
  PacketFloat center(int k) const { return column[number(__builtin_offsetof(SharePatch, center)) + k]; }
  PacketFloat inverse_half() const { return column[number(__builtin_offsetof(SharePatch, inverse_half))]; }
  static constexpr int number(unsigned long offset) { return static_cast<int>(offset / sizeof(float)); }
};

template <class F>
struct PatchCoefficients {
  const Patches<F>& patches;
  F at(int monomial) const { return patches.coefficient(monomial); }
};

// The share along rays: the polynomials of patches from the place `from` on, to within `spread`.
template <class F>
struct ShareOnRun {
  static constexpr int degree = SharePatch::degree;
  F from{};
  OnWay<degree, F> way{};
  F spread{};

  ShareOnRun() = default;
  explicit ShareOnRun(const ShareLine<F>& line) : spread(0.5F * (line.high - line.low)) {
    way.c[0] = line.at + 0.5F * (line.low + line.high);
    way.c[1] = line.slope;
  }
  ShareOnRun(const Patches<F>& patches, const RayOf<F>& ray, F t) : from(t) {
    WayLine<F> z[3];
    for (int k = 0; k < 3; ++k)
      z[k] = {(ray.origin[k] + ray.direction[k] * t - patches.center(k)) * patches.inverse_half(),
              ray.direction[k] * patches.inverse_half()};
    way = nested_polynomial<degree>(PatchCoefficients<F>{patches}, z[0], z[1], z[2]);
  }

  // The Taylor coefficients at t.
  OnWay<degree, F> at(F t) const {
    OnWay<degree, F> p = way;
    const F h = t - from;
    for (int i = 0; i < degree; ++i)
      for (int k = degree - 1; k >= i; --k) p.c[k] += p.c[k + 1] * h;
    return p;
  }
};

// Of the part of the block in which a ray is at t, until it leaves that by more than places are rounded.
template <class F>
struct ShareInPatch {
  ShareOnRun<F> share;
  F end;

  ShareInPatch(const BlocksOf<F>& blocks, const RayOf<F>& ray, F t, MaskOf<F> rays) {
    Patches<F> patches;
    const IntOf<F> layer[3] = {layer_of<SharePart::layers>(ray.origin[0] + ray.direction[0] * t),
                               layer_of<SharePart::layers>(ray.origin[1] + ray.direction[1] * t),
                               layer_of<SharePart::layers>(ray.origin[2] + ray.direction[2] * t)};
    patches.find(blocks, rays, layer);
    share = ShareOnRun<F>(patches, ray, t);
    const F center[3] = {patches.center(0), patches.center(1), patches.center(2)};
    end = leave_part(ray, center, 1 / patches.inverse_half());
    end = select(end > t, end, all_lanes<F>(infinity));
  }
};
