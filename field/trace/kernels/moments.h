// Moments of far sources (far_field.h), and bounds of the field over the octants of a cube. Part of
// block_kernels_<set>.cpp.

constexpr int monomials_to(int degree) { return (degree + 1) * (degree + 2) * (degree + 3) / 6; }

// All monomials of degree <= Degree, each a smaller one times a coordinate, in the order of far_field.h.
template <int Degree>
inline void fill_monomials(V16 x, V16 y, V16 z, V16 (&m)[monomials_to(Degree)]) {
  m[0] = splat(1);
  m[1] = x, m[2] = y, m[3] = z;
  for (int d = 2; d <= Degree; ++d) {
    const int before = monomials_to(d - 2), here = monomials_to(d - 1), count = here - before;
    V16* const to = m + here;
    for (int i = 0; i < count; ++i) to[i] = x * m[before + i];
    for (int i = 0; i < d; ++i) to[count + i] = y * m[here - d + i];
    to[count + d] = z * m[here - 1];
  }
}

// The number of moments for the degree P + 1 = Degree, see MomentTable.
constexpr int moments_to(int degree) { return degree < 0 ? 0 : monomials_to(degree) + moments_to(degree - 2); }

// For one j after the other the sums of f y^k |y|^(2j) over k + 2j <= Degree, without their constant factors; those of
// the field stop at a degree less. `field` is f |y|^(2j).
template <int Degree, int Monomials>
inline void accumulate_moments(const V16 (&power)[Monomials], V16 field, V16 squared, V16 tau, V16* f, V16* potential) {
  for (int i = 0; i < monomials_to(Degree - 1); ++i) {
    const V16 v = field * power[i];
    f[i] += v;
    potential[i] += v * tau;
  }
  const V16 field_tau = field * tau;
  for (int i = monomials_to(Degree - 1); i < monomials_to(Degree); ++i) potential[i] += field_tau * power[i];
  if constexpr (Degree >= 2)
    accumulate_moments<Degree - 2>(power, field * squared, squared, tau, f + monomials_to(Degree),
                                   potential + monomials_to(Degree));
}

template <int FarDegree>
struct MomentSums {
  static constexpr int degree = FarDegree + 1, count = (moments_to(degree) + 7) / 8 * 8;
  static_assert(count <= most_far_moments);
  V16 f[count] = {}, potential[count] = {};

  // One inverted source in each lane.
  void add(V16 x, V16 y, V16 z, V16 field, V16 tau) {
    V16 power[monomials_to(degree)];
    fill_monomials<degree>(x, y, z, power);
    accumulate_moments<degree>(power, field, x * x + y * y + z * z, tau, f, potential);
  }
  void write(float* f_out, float* potential_out) const {
    for (int i = 0; i < count; i += 8) {  // eight sums of each kind at a time
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

template <int FarDegree>
inline void sum_moments(const float* group, int groups, float* f_out, float* potential_out) {
  MomentSums<FarDegree> sums;
  for (int k = 0; k < groups; ++k, group += floats_per_group)
    sums.add(load(group), load(group + 16), load(group + 32), load(group + 48), load(group + 64));
  sums.write(f_out, potential_out);
}

void far_moments(const float* groups, int count, int far_degree, float* f_out, float* potential_out) {
  if (far_degree == 4) sum_moments<4>(groups, count, f_out, potential_out);
  else if (far_degree == 6) sum_moments<6>(groups, count, f_out, potential_out);
  else sum_moments<8>(groups, count, f_out, potential_out);
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
    const V16 t = select(along < 0.0F, V16{}, select(along > 1.0F, splat(1), along));
    const V16 dx = wx - ax * t, dy = wy - ay * t, dz = wz - az * t;
    const V16 share = load(group + 112), taper = load(group + 128), tau = load(group + 144), size = load(group + 160),
              reach = load(group + 176);
    const V16 d = root_of(dx * dx + dy * dy + dz * dz), slack = 2e-6F * (1.0F + d + size);
    const V16 nearest = d - (radius + reach + slack), high = tau / larger(nearest, splat(1e-4F));
    const V16 field = share * inverse_power<Exponent>(high * high, exponent);
    // All of a piece is within its length of the nearest point, and nowhere thinner than its thin end.
    const V16 thin = tau - select(taper < 0.0F, V16{} - taper, taper), middle = tau / larger(d, 0.5F * tau);
    const V16 low = thin / (d + size + radius + slack);
    const V16 weight = share * inverse_power<Exponent>(middle * middle, exponent);
    a[0] += field;
    a[1] += field * high;
    a[2] += select(thin > 0.0F, share * (tau / thin) * inverse_power<Exponent>(low * low, exponent), V16{});
    a[3] += weight;
    a[4] += weight * tau;
    touching = larger(touching, select(share > 0.0F, 1e-4F - nearest, splat(-1)));
    // Farther away than this a piece is no more than a hundredth of the field, and its own surface ends before.
    const V16 thick = larger(load(group + 192), splat(1e-9F));
    const V16 thinness_here = select(nearest < 4.0F * thick, 1.0F / thick, V16{});
    thinness = larger(thinness, select(share > 0.0F, thinness_here, V16{}));
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
