// The share of the range of angles on a ray, where directions give it: a polynomial for each part of a block
// (share_patch.h of the folder above). Part of block_kernels_<set>.cpp.

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

// Calls visit(patch, rays) for the parts of blocks that hold slots, by their layers.
template <class Visit>
inline void visit_patches(const BlocksOf<float>& blocks, bool ray, const int (&layer)[3], const Visit& visit) {
  if (ray) visit(blocks.block->patch(layer), true);
}
template <class Visit>
inline void visit_patches(const BlocksOf<PacketFloat>& blocks, PacketInt rays, const PacketInt (&layer)[3],
                          const Visit& visit) {
  // All parts are looked up first, those of rays in one slot once: none waits for what another one is found to be, so
  // that the machine waits for memory only once for many.
  const SharePatch* found[packet_lanes];
  PacketInt in_slot[packet_lanes];
  int count = 0;
  for (PacketInt left = rays; any(left); left &= ~in_slot[count++]) {
    const int first = __builtin_ctz(lane_bits(left));
    const int at[3] = {layer[0][first], layer[1][first], layer[2][first]};
    in_slot[count] =
        left & (blocks.cell == blocks.cell[first]) & (layer[0] == at[0]) & (layer[1] == at[1]) & (layer[2] == at[2]);
    found[count] = &blocks.of(first).patch(at);
  }
  for (int i = 0; i < count; ++i) {
    PacketInt here = in_slot[i];
    while (i + 1 < count && found[i + 1] == found[i]) here |= in_slot[++i];
    visit(*found[i], here);
  }
}

// The share on a stretch of a ray: on a line in t, but for what lies between two numbers.
template <class F>
struct ShareLine {
  F at{}, slope{};
  F low{}, high{};
};
inline void assign(PacketInt mask, ShareLine<PacketFloat>& to, const ShareLine<PacketFloat>& from) {
  using Line = ShareLine<PacketFloat>;
  for (PacketFloat Line::*part : {&Line::at, &Line::slope, &Line::low, &Line::high}) assign(mask, to.*part, from.*part);
}

// Those of the parts that rays came to last.
template <class F>
class PatchLines {
 public:
  void find(const BlocksOf<F>& blocks, const RayOf<F>& ray, MaskOf<F> rays, const IntOf<F> (&layer)[3]) {
    visit_patches(blocks, rays & !hold(layer), layer, [&](const SharePatch& patch, MaskOf<F> here) {
      const int log2 = patch.layers_log2;
      for (int k = 0; k < 3; ++k) key_[k] = select(here, layer[k] >> log2, key_[k]);
      shift_ = select(here, IntOf<F>{} + log2, shift_);
      F at = all_lanes<F>(patch.level), slope{};
      for (int k = 0; k < 3; ++k) {
        at += patch.slope[k] * (ray.origin[k] - patch.center[k]);
        slope += patch.slope[k] * ray.direction[k];
      }
      at_ = select(here, at, at_);
      slope_ = select(here, slope, slope_);
      bent_ = select(here, all_lanes<F>(patch.bent), bent_);
    });
  }

  ShareLine<F> line() const { return {at_, slope_, -bent_, bent_}; }
  // Holds what is here from `begin` to `end`, too.
  void widen(MaskOf<F> rays, F begin, F end, ShareLine<F>& line) const {
    const F at = at_ - line.at, slope = slope_ - line.slope, a = at + slope * begin, b = at + slope * end;
    assign(rays, line.low, min_of(line.low, min_of(a, b) - bent_));
    assign(rays, line.high, max_of(line.high, max_of(a, b) + bent_));
  }

 private:
  MaskOf<F> hold(const IntOf<F> (&layer)[3]) const {
    return (layer[0] >> shift_ == key_[0]) & (layer[1] >> shift_ == key_[1]) & (layer[2] >> shift_ == key_[2]);
  }

  IntOf<F> key_[3] = {IntOf<F>{} - 1, IntOf<F>{} - 1, IntOf<F>{} - 1}, shift_{};
  F at_{}, slope_{}, bent_{};
};

// The parts in which rays are.
template <class F>
struct Patches;

template <>
struct Patches<float> {
  const SharePatch* patch = nullptr;

  void find(const BlocksOf<float>& blocks, bool ray, const int (&layer)[3]) {
    visit_patches(blocks, ray, layer, [&](const SharePatch& found, bool) { patch = &found; });
  }
  float coefficient(int i) const { return patch->coefficient[i]; }
  float center(int k) const { return patch->center[k]; }
  float inverse_half() const { return patch->inverse_half; }
};

template <>
struct Patches<PacketFloat> {
  PacketFloat column[floats_per_patch];  // what the patches hold, a ray in each lane

  void find(const BlocksOf<PacketFloat>& blocks, PacketInt rays, const PacketInt (&layer)[3]) {
    static constexpr SharePatch none{};
    const SharePatch* patch[packet_lanes];
    for (const SharePatch*& p : patch) p = &none;
    visit_patches(blocks, rays, layer, [&](const SharePatch& found, PacketInt here) {
      for (unsigned left = lane_bits(here); left != 0; left &= left - 1) patch[__builtin_ctz(left)] = &found;
    });
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

// The layer of a coordinate.
template <class F>
inline IntOf<F> layer_of(F x) {
  constexpr float last = 7.5F;
  return whole_part(max_of(0.0F, min_of(x * 4 + 4, last)));
}

// Of the part of the block in which a ray is at t, until it leaves that by more than places are rounded.
template <class F>
struct ShareInPatch {
  ShareOnRun<F> share;
  F end = all_lanes<F>(infinity);

  ShareInPatch(const BlocksOf<F>& blocks, const RayOf<F>& ray, F t, MaskOf<F> rays) {
    constexpr float clearly = 1e-6F, outermost = 1 - clearly;
    Patches<F> patches;
    const IntOf<F> layer[3] = {layer_of(ray.origin[0] + ray.direction[0] * t),
                               layer_of(ray.origin[1] + ray.direction[1] * t),
                               layer_of(ray.origin[2] + ray.direction[2] * t)};
    patches.find(blocks, rays, layer);
    share = ShareOnRun<F>(patches, ray, t);
    const F half = 1 / patches.inverse_half();
    for (int k = 0; k < 3; ++k) {
      const F d = nonzero(ray.direction[k]), face = patches.center(k) + select(d > 0.0F, half, -half);
      // The outer ones go on beyond the block.
      const F leave = (face + select(d > 0.0F, all_lanes<F>(clearly), all_lanes<F>(-clearly)) - ray.origin[k]) / d;
      end = min_of(end, select(abs_of(face) < outermost, leave, all_lanes<F>(infinity)));
    }
    end = select(end > t, end, all_lanes<F>(infinity));
  }
};
