// Bounds of the field over a cube. Part of block_kernels_<set>.cpp.

// Of sixteen sources over the ball of this radius about p. With d the distance of a source, w (d -+ R)^-m bounds a term
// of f, and m w tau ((d-R)^-(m+1) - d^-(m+1)) the change of one of G.
struct CubeTerms {
  float p[3], radius;

  // a: f_high, the change of G over m, the sum of G at p over -m, f_low; `nearest`: the largest R / d.
  template <int Exponent>
  void add(const float* group, int exponent, V16 (&a)[12], V16& nearest) const {
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
  // The largest (R / d)^2.
  float nearness(const float* group) const {
    const V16 dx = p[0] - load(group), dy = p[1] - load(group + 16), dz = p[2] - load(group + 32);
    return largest_lane(select(load(group + 48) > 0.0F, radius * radius / (dx * dx + dy * dy + dz * dz), V16{}));
  }
};

// What the sources of a level come to.
struct CubeSums {
  float f_high = 0, g_change = 0, g[3] = {}, f_low = 0;
  bool touches = false;

  void add(const V16 (&a)[12], V16 nearest, float m) {
    float s[16];
    sum_lanes(a, s);
    f_high += s[0];
    g_change += m * s[1];
    for (int i = 0; i < 3; ++i) g[i] -= m * s[2 + i];
    f_low += s[5];
    if (!(largest_lane(nearest) < 0.99F)) touches = true;
  }
  void add(const CubeSums& more) {
    f_high += more.f_high;
    g_change += more.g_change;
    for (int i = 0; i < 3; ++i) g[i] += more.g[i];
    f_low += more.f_low;
    touches |= more.touches;
  }
  // With the far field of the level about the centre of the cube.
  CubeBounds bounds(const FieldLevel& level, const CubeTerms& cube) const {
    const V4 far = far_at(level, cube.p[0], cube.p[1], cube.p[2]);
    float yy = 0;
    for (int i = 0; i < 3; ++i) yy += (g[i] + far[i + 1]) * (g[i] + far[i + 1]);
    CubeBounds b;
    b.f_high = (f_high + far[0] + level.far_slope * cube.radius + level.f_error) * (1 + rounding);
    b.g_high = (root_of(yy) + g_change + level.far_g_slope * cube.radius + level.g_error) * (1 + rounding);
    b.f_low = (f_low + far[0] - level.far_slope * cube.radius - level.f_error) * (1 - rounding);
    b.touches = touches;
    return b;
  }
};

inline CubeTerms ball_about(const float (&center)[3], float half) {
  constexpr float diagonal = 1.7322F;
  return {{center[0], center[1], center[2]}, half * diagonal};
}

struct CubeSummer {
  const CubeTerms& cube;
  CubeSums& out;

  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    V16 a[12] = {}, nearest{};
    for (int k = 0; k < groups; ++k, group += floats_per_group)
      cube.template add<Exponent>(group, exponent, a, nearest);
    out.add(a, nearest, static_cast<float>(Exponent > 0 ? Exponent : exponent));
  }
};

CubeBounds cube_bounds(const FieldLevel& level, int degree, const float center[3], float half) {
  const CubeTerms cube = ball_about({center[0], center[1], center[2]}, half);
  CubeSums sums;
  for_each_list(level, degree, CubeSummer{cube, sums});
  return sums.bounds(level, cube);
}

// Groups of sources that are near the whole cube go octant by octant, all others once. Those more than twice as far as
// the nearest count 2^-m of it, and what bounds over the cube instead of its octants add to that is a part of it again.
struct OctantsSummer {
  const CubeTerms& cube;
  const CubeTerms (&octants)[8];
  CubeSums& far;
  CubeSums (&near)[8];

  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    constexpr float far_distances = 2;
    constexpr int most_near = 64;  // groups beyond these are bounded as if they were far
    const float m = static_cast<float>(Exponent > 0 ? Exponent : exponent);
    const float* listed[most_near];
    int count = 0;
    float nearness = 0;
    for (int k = 0; k < groups; ++k) nearness = max_of(nearness, cube.nearness(group + k * floats_per_group));
    const float near_from = root_of(nearness) / far_distances;
    V16 a[12] = {}, nearest{};
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      V16 of_group[12] = {}, here{};
      cube.template add<Exponent>(group, exponent, of_group, here);
      if (count < most_near && !(largest_lane(here) < near_from)) {
        listed[count++] = group;
        continue;
      }
      for (int i = 0; i < 6; ++i) a[i] += of_group[i];
      nearest = larger(nearest, here);
    }
    far.add(a, nearest, m);
    for (int octant = 0; octant < 8; ++octant) {
      V16 b[12] = {}, closest{};
      for (int k = 0; k < count; ++k) octants[octant].template add<Exponent>(listed[k], exponent, b, closest);
      near[octant].add(b, closest, m);
    }
  }
};

void octant_cube_bounds(const FieldLevel& level, int degree, const float center[3], float half, float margin,
                        CubeBounds (&out)[8]) {
  const CubeTerms cube = ball_about({center[0], center[1], center[2]}, half + margin);
  CubeTerms octants[8];
  for (int octant = 0; octant < 8; ++octant) {
    float place[3];
    for (int k = 0; k < 3; ++k) place[k] = center[k] + (octant >> k & 1 ? 0.5F : -0.5F) * half;
    octants[octant] = ball_about(place, 0.5F * half + margin);
  }
  CubeSums far, near[8];
  for_each_list(level, degree, OctantsSummer{cube, octants, far, near});
  for (int octant = 0; octant < 8; ++octant) {
    near[octant].add(far);
    out[octant] = near[octant].bounds(level, octants[octant]);
  }
}
