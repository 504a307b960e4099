// Which sub-cells of a block may hold surface, by bounds over balls. Part of block_kernels_<set>.cpp.

struct BallBounds {
  float x_up = 0;        // of f
  float g[3] = {};       // G at the centre
  float deviation = 0;   // of G in the ball
  bool touches = false;  // a source comes into the ball
};

// |p + v - q| >= d - R: w (d-R)^-m bounds a term of f, and m w tau ((d-R)^-(m+1) - d^-(m+1)) the change of one of G.
struct BallSummer {
  const float* p;
  float radius;
  BallBounds& out;

  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    const float m = static_cast<float>(Exponent > 0 ? Exponent : exponent);
    V16 a[12] = {}, nearest{};
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      const V16 dx = p[0] - load(group), dy = p[1] - load(group + 16), dz = p[2] - load(group + 32);
      const V16 inv = 1.0F / (dx * dx + dy * dy + dz * dz), inv_d = root_of(inv), q = radius * inv_d;
      const V16 stretch = 1.0F / larger(1.0F - q, splat(1e-3F));
      const V16 raised = inverse_power<Exponent>(stretch * stretch, exponent);
      const V16 w0 = load(group + 48) * inverse_power<Exponent>(inv, exponent);
      const V16 k1 = w0 * load(group + 64) * inv_d, k2 = k1 * inv_d;
      a[0] += w0 * raised;
      a[1] += k1 * (raised * stretch - 1.0F);
      a[2] += k2 * dx;
      a[3] += k2 * dy;
      a[4] += k2 * dz;
      nearest = larger(nearest, q);
    }
    float s[16];
    sum_lanes(a, s);
    out.x_up += s[0];
    out.deviation += m * s[1];
    for (int i = 0; i < 3; ++i) out.g[i] -= m * s[2 + i];
    if (!(largest_lane(nearest) < 0.99F)) out.touches = true;
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

inline bool may_hold_surface(const BlockView& block, const float p[3], float radius, float far_f, float far_g) {
  const FieldLevel& level = block.coarse;
  BallBounds b;
  for_each_list(level, block.degree, BallSummer{p, radius, b});
  if (b.touches) return true;
  const V4 far = far_at(level, p[0], p[1], p[2]);
  float yy = 0;
  for (int i = 0; i < 3; ++i) yy += (b.g[i] + far[i + 1]) * (b.g[i] + far[i + 1]);
  const float x = (b.x_up + far[0] + far_f * radius + level.f_error) * (1 + rounding);
  const float y = (root_of(yy) + b.deviation + far_g * radius + level.g_error) * (1 + rounding);
  if (block.iso.two_sided && !(margin_at(block.iso, 0, y) > 0)) return true;
  return !(margin_at(block.iso, x, y) > 0);
}

std::uint64_t mask(const BlockView& block) {
  float far_f, far_g;
  far_slopes(block.coarse, far_f, far_g);
  constexpr float half = 1.0F / mask_size;
  constexpr float radius = half * 1.7322F * 1.0001F;  // sqrt(3), and an overlap that hides rounding at shared faces
  std::uint64_t bits = 0;
  for (int i = 0; i < mask_size * mask_size * mask_size; ++i) {
    const int cell[3] = {i % mask_size, i / mask_size % mask_size, i / (mask_size * mask_size)};
    float p[3];
    for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(2 * cell[k] + 1) * half - 1;
    if (may_hold_surface(block, p, radius, far_f, far_g)) bits |= std::uint64_t{1} << i;
  }
  return bits;
}
