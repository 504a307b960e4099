// Moments of far sources (far_field.h), and bounds of the field over the octants of a cube. Part of
// block_kernels_<set>.cpp.

// All monomials of degree <= 5, each a smaller one times a coordinate, in the order of far_field.h.
inline void fill_monomials(V16 x, V16 y, V16 z, V16 (&m)[56]) {
  m[0] = splat(1);
  m[1] = x, m[2] = y, m[3] = z;
  m[4] = x * x, m[5] = x * y, m[6] = x * z, m[7] = y * y, m[8] = y * z, m[9] = z * z;
  for (int i = 0; i < 6; ++i) m[10 + i] = x * m[4 + i];
  for (int i = 0; i < 3; ++i) m[16 + i] = y * m[7 + i];
  m[19] = z * m[9];
  for (int i = 0; i < 10; ++i) m[20 + i] = x * m[10 + i];
  for (int i = 0; i < 4; ++i) m[30 + i] = y * m[16 + i];
  m[34] = z * m[19];
  for (int i = 0; i < 15; ++i) m[35 + i] = x * m[20 + i];
  for (int i = 0; i < 5; ++i) m[50 + i] = y * m[30 + i];
  m[55] = z * m[34];
}

// For one j the sums of f y^k |y|^(2j) over k <= Degree, without their constant factors; `field` is f |y|^(2j).
template <int Degree>
inline void accumulate_tensor(const V16 (&power)[56], V16 field, V16 tau, V16* f, V16* potential) {
  constexpr int size[] = {1, 4, 10, 20, 35, 56};
  for (int i = 0; i < size[Degree]; ++i) {
    const V16 v = field * power[i];
    f[i] += v;
    potential[i] += v * tau;
  }
}

struct MomentSums {
  V16 f[far_moment_count] = {}, potential[far_moment_count] = {};

  // One inverted source in each lane.
  void add(V16 x, V16 y, V16 z, V16 field, V16 tau) {
    V16 power[56];
    fill_monomials(x, y, z, power);
    const V16 squared = x * x + y * y + z * z, field2 = field * squared;
    accumulate_tensor<5>(power, field, tau, f, potential);
    accumulate_tensor<3>(power, field2, tau, f + 56, potential + 56);
    accumulate_tensor<1>(power, field2 * squared, tau, f + 76, potential + 76);
  }
  void write(float* f_out, float* potential_out) const {
    static_assert(far_moment_count == 80);
    for (int i = 0; i < far_moment_count; i += 8) {  // eight sums of each kind at a time
      V16 a[12] = {};
      float s[16];
      for (int k = 0; k < 8; ++k) a[k] = f[i + k];
      sum_lanes(a, s);
      for (int k = 0; k < 8; ++k) f_out[i + k] = s[k];
      for (int k = 0; k < 8; ++k) a[k] = potential[i + k];
      sum_lanes(a, s);
      for (int k = 0; k < 8; ++k) potential_out[i + k] = s[k];
    }
  }
};

void far_moments(const float* group, int groups, float* f_out, float* potential_out) {
  MomentSums sums;
  for (int k = 0; k < groups; ++k, group += floats_per_group)
    sums.add(load(group), load(group + 16), load(group + 32), load(group + 48), load(group + 64));
  sums.write(f_out, potential_out);
}

// One kind of pieces (one exponent) against one ball. Distances are lowered and raised by what rounding can do to
// numbers of the size of the coordinates. Fields are powers of tau / d, which no scale can make overflow early.
template <int Exponent>
inline void add_octant(const float* group, int groups, int exponent, const float (&c)[3], float radius,
                       OctantBounds& out) {
  V16 a[12] = {}, touching{}, thinness{};
  for (int k = 0; k < groups; ++k, group += floats_per_piece_group) {
    const V16 wx = c[0] - load(group), wy = c[1] - load(group + 16), wz = c[2] - load(group + 32);
    const V16 ax = load(group + 48), ay = load(group + 64), az = load(group + 80);
    const V16 along = (wx * ax + wy * ay + wz * az) * load(group + 96);  // 1 / length^2
    const V16 t = along < 0.0F ? V16{} : along > 1.0F ? splat(1) : along;
    const V16 dx = wx - ax * t, dy = wy - ay * t, dz = wz - az * t;
    const V16 share = load(group + 112), taper = load(group + 128), tau = load(group + 144), size = load(group + 160),
              reach = load(group + 176);
    const V16 d = root_of(dx * dx + dy * dy + dz * dz), slack = 2e-6F * (1.0F + d + size);
    const V16 nearest = d - (radius + reach + slack), high = tau / larger(nearest, splat(1e-4F));
    const V16 field = share * inverse_power<Exponent>(high * high, exponent);
    // All of a piece is within its length of the nearest point, and nowhere thinner than its thin end.
    const V16 thin = tau - (taper < 0.0F ? V16{} - taper : taper), middle = tau / larger(d, 0.5F * tau);
    const V16 low = thin / (d + size + radius + slack);
    const V16 weight = share * inverse_power<Exponent>(middle * middle, exponent);
    a[0] += field;
    a[1] += field * high;
    a[2] += thin > 0.0F ? share * (tau / thin) * inverse_power<Exponent>(low * low, exponent) : V16{};
    a[3] += weight;
    a[4] += weight * tau;
    touching = larger(touching, share > 0.0F ? 1e-4F - nearest : V16{} - 1.0F);
    // Farther away than this a piece is no more than a hundredth of the field, and its own surface ends before.
    const V16 thick = larger(load(group + 192), splat(1e-9F));
    const V16 thinness_here = nearest < 4.0F * thick ? 1.0F / thick : V16{};
    thinness = larger(thinness, share > 0.0F ? thinness_here : V16{});
  }
  float s[16];
  sum_lanes(a, s);
  out.f_high += s[0] * (1 + rounding);
  out.gradient_high += static_cast<float>(exponent) * s[1] * (1 + rounding);
  out.f_low += s[2] * (1 - rounding);
  out.weight += s[3];
  out.weighted_radius += s[4];
  if (largest_lane(touching) > 0) out.touches = true;
  out.thinness = max_of(out.thinness, largest_lane(thinness));
}

void octant_bounds(const float* pieces, int curve_groups, int point_groups, int degree, OctantBounds* out) {
  constexpr float radius = 0.5F * 1.7320509F;  // of a half-sized cube, rounded up
  const float* points = pieces + static_cast<long>(curve_groups) * floats_per_piece_group;
  for (int octant = 0; octant < 8; ++octant) {
    float c[3];
    for (int i = 0; i < 3; ++i) c[i] = octant >> i & 1 ? 0.5F : -0.5F;
    out[octant] = {};
    if (degree == 4) add_octant<4>(pieces, curve_groups, 4, c, radius, out[octant]);
    else add_octant<0>(pieces, curve_groups, degree, c, radius, out[octant]);
    if (point_groups > 0) add_octant<0>(points, point_groups, degree - 1, c, radius, out[octant]);
  }
}
