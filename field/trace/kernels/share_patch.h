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

// The parts of the block in which rays are.
template <class F>
struct Patches;

template <>
struct Patches<float> {
  const SharePatch* patch = nullptr;
  int key[3], shift = 0;

  void find(const BlocksOf<float>& blocks, bool ray, const int (&layer)[3]) {
    if (!ray) return;
    patch = &blocks.block->patch(layer);
    shift = patch->layers_log2;
    for (int k = 0; k < 3; ++k) key[k] = layer[k] >> shift;
  }
  float coefficient(int i) const { return patch->coefficient[i]; }
  void load() const {}
  float center(int k) const { return patch->center[k]; }
  float inverse_half() const { return patch->inverse_half; }
  bool hold(const int (&layer)[3]) const {
    return layer[0] >> shift == key[0] && layer[1] >> shift == key[1] && layer[2] >> shift == key[2];
  }
};

template <>
struct Patches<PacketFloat> {
  const SharePatch* patch[packet_lanes] = {};
  PacketInt key[3] = {}, shift{};
  PacketFloat column[floats_per_patch];  // what the patches hold, a ray in each lane

  void find(const BlocksOf<PacketFloat>& blocks, PacketInt rays, const PacketInt (&layer)[3]) {
    // Neighbours are mostly in one part.
    while (any(rays)) {
      const int first = __builtin_ctz(lane_bits(rays));
      const int at[3] = {layer[0][first], layer[1][first], layer[2][first]};
      const SharePatch& found = blocks.of(first).patch(at);
      const int log2 = found.layers_log2;
      PacketInt here = rays & (blocks.cell == blocks.cell[first]);
      for (int k = 0; k < 3; ++k) here &= layer[k] >> log2 == at[k] >> log2;
      for (unsigned left = lane_bits(here); left != 0; left &= left - 1) patch[__builtin_ctz(left)] = &found;
      for (int k = 0; k < 3; ++k) key[k] = select(here, layer[k] >> log2, key[k]);
      shift = select(here, PacketInt{} + log2, shift);
      rays &= ~here;
    }
  }
  PacketInt hold(const PacketInt (&layer)[3]) const {
    return (layer[0] >> shift == key[0]) & (layer[1] >> shift == key[1]) & (layer[2] >> shift == key[2]);
  }
  void load() {
    static constexpr SharePatch none{};
    for (int part = 0; part < floats_per_patch; part += lanes) {
      V16 rows[packet_lanes];
      for (int lane = 0; lane < packet_lanes; ++lane)
        __builtin_memcpy(
            &rows[lane],
            reinterpret_cast<const char*>(patch[lane] != nullptr ? patch[lane] : &none) + part * sizeof(float),
            sizeof(V16));
      PacketFloat columns[lanes];
      find_columns(rows, columns);
      for (int i = 0; i < lanes; ++i) column[part + i] = columns[i];
    }
  }
  PacketFloat coefficient(int i) const { return column[i]; }
  PacketFloat center(int k) const { return column[SharePatch::coefficients + k]; }
  PacketFloat inverse_half() const { return column[SharePatch::coefficients + 3]; }
};

template <class F>
struct PatchCoefficients {
  const Patches<F>& patches;
  F at(int monomial) const { return patches.coefficient(monomial); }
};

// The polynomials of the patches along their rays, from the place `from` on.
template <class F>
struct ShareOnRun {
  static constexpr int degree = SharePatch::degree;
  F from{};
  OnWay<degree, F> way{};

  ShareOnRun() = default;
  ShareOnRun(Patches<F>& patches, const RayOf<F>& ray, F t) : from(t) {
    patches.load();
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

// Where a ray leaves the part of the block that it is in.
template <class F>
inline F end_of_patch(Patches<F>& patches, const RayOf<F>& ray) {
  patches.load();
  F end = all_lanes<F>(infinity);
  for (int k = 0; k < 3; ++k) {
    const F d = nonzero(ray.direction[k]), half = 1 / patches.inverse_half();
    end = min_of(end, (patches.center(k) + select(d > 0.0F, half, -half) - ray.origin[k]) / d);
  }
  return end;
}
