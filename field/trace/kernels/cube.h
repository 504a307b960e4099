// Bounds of the field over a cube, and which cells of a lattice may hold surface. Part of block_kernels_<set>.cpp.

// With R the radius of the ball around the cube |p + v - q| is d - R to d + R: w (d -+ R)^-m bounds a term of f, and
// m w tau ((d-R)^-(m+1) - d^-(m+1)) the change of one of G.
struct CubeSummer {
  const float* p;
  float half;
  const LatticeError* errors;  // of curves, and of points
  int degree;
  CubeBounds& out;
  float (&g)[3];

  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    const float m = static_cast<float>(Exponent > 0 ? Exponent : exponent), radius = half * 1.7322F;
    const LatticeError& lattice = errors[exponent == degree ? 0 : 1];
    const float per_half2 = 1 / (half * half);
    V16 a[12] = {}, nearest{}, closest = splat(infinity);
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      const V16 dx = p[0] - load(group), dy = p[1] - load(group + 16), dz = p[2] - load(group + 32);
      const V16 weight = load(group + 48), tau = load(group + 64);
      const V16 d2 = dx * dx + dy * dy + dz * dz, inv = 1.0F / d2, inv_d = root_of(inv), q = radius * inv_d;
      const V16 stretch = 1.0F / larger(1.0F - q, splat(1e-3F)), shrink = 1.0F / (1.0F + q);
      const V16 w0 = weight * inverse_power<Exponent>(inv, exponent), k1 = w0 * tau * inv_d, k2 = k1 * inv_d;
      const V16 raised = inverse_power<Exponent>(stretch * stretch, exponent);
      a[0] += w0 * raised;
      a[1] += k1 * (raised * stretch - 1.0F);
      a[2] += k2 * dx;
      a[3] += k2 * dy;
      a[4] += k2 * dz;
      a[5] += w0 * inverse_power<Exponent>(shrink * shrink, exponent);
      nearest = larger(nearest, weight > 0.0F ? q : V16{});
      const V16 scaled = weight > 0.0F ? d2 * per_half2 : splat(1e6F);
      closest = closest < scaled ? closest : scaled;
      const V16 u = 1.0F / larger(scaled - LatticeError::offset, splat(1)), u_root = root_of(u);
      const V16 e = weight * (inverse_power<Exponent>(u, exponent) * (u * u)) * u_root;
      a[6] += e;
      a[7] += e * u_root * tau;
    }
    float s[16];
    sum_lanes(a, s);
    out.f_high += s[0];
    out.g_high += m * s[1];
    out.f_low += s[5];
    for (int i = 0; i < 3; ++i) g[i] -= m * s[2 + i];
    if (!(largest_lane(nearest) < 0.99F)) out.touches = true;
    // Weights and radii in units of the cube's half side: weight half^-m, tau / half.
    float scale = 1;
    for (int i = 0; i < exponent; ++i) scale /= half;
    if (!(-largest_lane(-closest) >= LatticeError::nearest)) scale = infinity;
    out.f_error += s[6] * scale * lattice.field;
    out.g_error += s[7] * scale / half * lattice.gradient;
  }
};

// Largest |gradient| of the far polynomials over the cube: each monomial has a gradient of at most its degree.
inline void far_slopes(const FieldLevel& level, float& f_slope, float& g_slope) {
  constexpr int degree_begin[] = {1, 4, 10, 20, far_monomials};
  float sum[4] = {};
  for (int degree = 1; degree <= 4; ++degree)
    for (int i = degree_begin[degree - 1]; i < degree_begin[degree]; ++i)
      for (int k = 0; k < 4; ++k) sum[k] += static_cast<float>(degree) * abs_of(level.far[4 * i + k]);
  f_slope = sum[0];
  g_slope = sum[1] + sum[2] + sum[3];
}

CubeBounds cube_bounds(const FieldLevel& level, int degree, const LatticeError errors[2], const float center[3],
                       float half) {
  CubeBounds b;
  float g[3] = {}, far_f, far_g;
  for_each_list(level, degree, CubeSummer{center, half, errors, degree, b, g});
  far_slopes(level, far_f, far_g);
  const V4 far = far_at(level, center[0], center[1], center[2]);
  const float radius = half * 1.7322F;
  float yy = 0;
  for (int i = 0; i < 3; ++i) yy += (g[i] + far[i + 1]) * (g[i] + far[i + 1]);
  b.f_high = (b.f_high + far[0] + far_f * radius + level.f_error) * (1 + rounding);
  b.g_high = (root_of(yy) + b.g_high + far_g * radius + level.g_error) * (1 + rounding);
  b.f_low = (b.f_low + far[0] - far_f * radius - level.f_error) * (1 - rounding);
  return b;
}

// The largest of each pair of neighbours along an axis.
template <int Stride>
inline void raise_pairs(float (&v)[lattice_stride], int count) {
  for (int i = 0; i + Stride < count; ++i) v[i] = max_of(v[i], v[i + Stride]);
}
template <int Stride>
inline void lower_pairs(float (&v)[lattice_stride], int count) {
  for (int i = 0; i + Stride < count; ++i) v[i] = min_of(v[i], v[i + Stride]);
}

std::uint64_t lattice_marks(const IsoCurve::View& iso, const LatticeRaise& raise, const float* values) {
  constexpr int side = 5, nodes = side * side * side, cells = side - 1;
  float high[lattice_stride], low[lattice_stride], steep[lattice_stride];
  for (int i = 0; i < nodes; ++i) {
    const float* v = values + 4 * i;
    high[i] = low[i] = v[0];
    steep[i] = root_of(v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
  }
  raise_pairs<1>(high, nodes), raise_pairs<side>(high, nodes), raise_pairs<side * side>(high, nodes);
  raise_pairs<1>(steep, nodes), raise_pairs<side>(steep, nodes), raise_pairs<side * side>(steep, nodes);
  lower_pairs<1>(low, nodes), lower_pairs<side>(low, nodes), lower_pairs<side * side>(low, nodes);
  std::uint64_t bits = 0;
  for (int cell = 0; cell < cells * cells * cells; ++cell) {
    const int i = cell % cells + side * (cell / cells % cells) + side * side * (cell / (cells * cells));
    const float x = (high[i] + raise.field) * (1 + rounding), y = (steep[i] + raise.gradient) * (1 + rounding);
    const float x_low = (low[i] - raise.field) * (1 - rounding);
    if (x_low > raise.surely_inside) continue;
    const bool outside = margin_at(iso, x, y) > 0 && (!iso.two_sided || margin_at(iso, max_of(0, x_low), y) > 0);
    if (!outside) bits |= std::uint64_t{1} << cell;
  }
  return bits;
}
