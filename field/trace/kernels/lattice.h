// The field at the nodes of a lattice (field/trace/lattice.h). Part of block_kernels_<set>.cpp.

struct LatticeSums {
  V16 f, gx, gy, gz;
};

// One source at a time against 16 nodes.
struct LatticeSummer {
  const V16 &px, &py, &pz;
  LatticeSums& out;

  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    const V16 m = splat(static_cast<float>(Exponent > 0 ? Exponent : exponent));
    LatticeSums s{};
    for (int k = 0; k < groups; ++k, group += floats_per_group)
      for (int lane = 0; lane < lanes; ++lane) {
        if (!(group[48 + lane] > 0)) continue;  // unused
        const float* source = group + lane;
        const V16 dx = px - source[0], dy = py - source[16], dz = pz - source[32];
        const V16 inv = 1.0F / (dx * dx + dy * dy + dz * dz);
        const V16 w0 = source[48] * inverse_power<Exponent>(inv, exponent), k2 = (w0 * inv) * source[64];
        s.f += w0;
        s.gx += k2 * dx;
        s.gy += k2 * dy;
        s.gz += k2 * dz;
      }
    out.f += s.f;
    out.gx -= m * s.gx;
    out.gy -= m * s.gy;
    out.gz -= m * s.gz;
  }
};

// (f, G) at the nodes of the cube with this centre and half side, and nodes beyond the last up to a whole vector.
void lattice_values(const FieldLevel& level, int degree, const float center[3], float half, float* values) {
  constexpr int side = 5, nodes = side * side * side;
  for (int begin = 0; begin < nodes; begin += lanes) {
    V16 px, py, pz;
    for (int lane = 0; lane < lanes; ++lane) {
      const int i = begin + lane;
      px[lane] = center[0] + half * (0.5F * static_cast<float>(i % side) - 1);
      py[lane] = center[1] + half * (0.5F * static_cast<float>(i / side % side) - 1);
      pz[lane] = center[2] + half * (0.5F * static_cast<float>(i / (side * side)) - 1);
    }
    const auto far = [&](int k) {
      return nested_polynomial<V16>(px, py, pz, [&](int i) { return splat(level.far[4 * i + k]); });
    };
    LatticeSums s{far(0), far(1), far(2), far(3)};
    for_each_list(level, degree, LatticeSummer{px, py, pz, s});
    for (int lane = 0; lane < lanes; ++lane) {
      float* out = values + 4 * (begin + lane);
      out[0] = s.f[lane];
      out[1] = s.gx[lane];
      out[2] = s.gy[lane];
      out[3] = s.gz[lane];
    }
  }
}
