// Bounds of the field over a cube. Part of block_kernels_<set>.cpp.

// With R the radius of the ball around the cube |p + v - q| is d - R to d + R: w (d -+ R)^-m bounds a term of f, and
// m w tau ((d-R)^-(m+1) - d^-(m+1)) the change of one of G.
struct CubeSummer {
  const float* p;
  float half;
  CubeBounds& out;
  float (&g)[3];

  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    const float m = static_cast<float>(Exponent > 0 ? Exponent : exponent), radius = half * 1.7322F;
    V16 a[12] = {}, nearest{};
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      const V16 dx = p[0] - load(group), dy = p[1] - load(group + 16), dz = p[2] - load(group + 32);
      const V16 share = load(group + 48), tau = load(group + 64);
      const V16 d2 = dx * dx + dy * dy + dz * dz, inv = 1.0F / d2, inv_d = root_of(inv), q = radius * inv_d;
      // 1 / (1 - q), where no source comes into the ball, and at most 1 / (1 + q)
      const V16 both = 1.0F / larger(1.0F - q * q, splat(1e-3F)), stretch = (1.0F + q) * both,
                shrink = larger(1.0F - q, V16{}) * both;
      const V16 w0 = field_of<Exponent>(share, tau, inv, exponent), k1 = w0 * tau * inv_d, k2 = k1 * inv_d;
      const V16 raised = inverse_power<Exponent>(stretch * stretch, exponent);
      a[0] += w0 * raised;
      a[1] += k1 * (raised * stretch - 1.0F);
      a[2] += k2 * dx;
      a[3] += k2 * dy;
      a[4] += k2 * dz;
      a[5] += w0 * inverse_power<Exponent>(shrink * shrink, exponent);
      nearest = larger(nearest, select(share > 0.0F, q, V16{}));
    }
    float s[16];
    sum_lanes(a, s);
    out.f_high += s[0];
    out.g_high += m * s[1];
    out.f_low += s[5];
    for (int i = 0; i < 3; ++i) g[i] -= m * s[2 + i];
    if (!(largest_lane(nearest) < 0.99F)) out.touches = true;
  }
};

CubeBounds cube_bounds(const FieldLevel& level, int degree, const float center[3], float half) {
  CubeBounds b;
  float g[3] = {};
  for_each_list(level, degree, CubeSummer{center, half, b, g});
  const V4 far = far_at(level, center[0], center[1], center[2]);
  const float radius = half * 1.7322F;
  float yy = 0;
  for (int i = 0; i < 3; ++i) yy += (g[i] + far[i + 1]) * (g[i] + far[i + 1]);
  b.f_high = (b.f_high + far[0] + level.far_slope * radius + level.f_error) * (1 + rounding);
  b.g_high = (root_of(yy) + b.g_high + level.far_g_slope * radius + level.g_error) * (1 + rounding);
  b.f_low = (b.f_low + far[0] - level.far_slope * radius - level.f_error) * (1 - rounding);
  return b;
}
