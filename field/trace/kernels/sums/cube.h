// Bounds of the field over a cube. Part of block_kernels_<set>.cpp.

// Sums over sources, in lanes: f_high, the change of G over m, the sum of G at p over -m, f_low; and the largest R / d.
struct CubeLanes {
  V16 sums[12] = {}, nearest{};
};

// Of sources over the ball of this radius about p. With d the distance of a source, w (d -+ R)^-m bounds a term
// of f, and m w tau ((d-R)^-(m+1) - d^-(m+1)) the change of one of G.
struct CubeTerms {
  static constexpr int count = 6;  // of sums in CubeLanes
  float p[3], radius;

  // Of the sources in a register: the way to p, 1 / d and 1 / (1 - q^2), q = R / d, from one division and one root.
  struct Ready {
    Native x, y, z, inverse, both;
  };
  Ready ready(const float* at) const {
    const Native x = p[0] - load_native(at), y = p[1] - load_native(at + 16), z = p[2] - load_native(at + 32);
    const Native d2 = larger(x * x + y * y + z * z, Native{} + 1e-12F);  // at p itself: far less than R away
    const Native gap = larger(d2 - radius * radius, 1e-3F * d2), of_both = 1.0F / (gap * d2);
    return {x, y, z, root_of(d2) * (gap * of_both), d2 * of_both * d2};
  }
  template <int Exponent>
  void add(const Ready& s, const float* at, int exponent, Native (&a)[count], Native& nearest) const {
    const Native share = load_native(at + 48), tau = load_native(at + 64), q = radius * s.inverse;
    // 1 / (1 - q), where no source comes into the ball, and at most 1 / (1 + q)
    const Native stretch = (1.0F + q) * s.both, shrink = larger(1.0F - q, Native{}) * s.both;
    const int m = Exponent > 0 ? Exponent : exponent;
    const Native ratio = tau * s.inverse, w0 = share * power_of(ratio, m), k1 = w0 * ratio, k2 = k1 * s.inverse;
    const Native raised = power_of(stretch, m);
    a[0] += w0 * raised;
    a[1] += k1 * (raised * stretch - 1.0F);
    a[2] += k2 * s.x;
    a[3] += k2 * s.y;
    a[4] += k2 * s.z;
    a[5] += w0 * power_of(shrink, m);
    nearest = larger(nearest, select(share > 0.0F, q, Native{}));
  }
  // One register of lanes after the other, so that sums stay in registers.
  template <int Exponent>
  CubeLanes lanes_of(const float* group, int groups, int exponent) const {
    Native a[count][natives] = {}, closest[natives] = {};
    for (int part = 0; groups > 0 && part < natives; ++part) {
      Native of_part[count] = {}, nearest{};
      const auto put = [&](const float* at, const Ready& s) { add<Exponent>(s, at, exponent, of_part, nearest); };
      for_each_source<Ready>(
          group + part * native_lanes, groups, floats_per_group, [&](const float* at) { return ready(at); }, put, put);
      for (int i = 0; i < count; ++i) a[i][part] = of_part[i];
      closest[part] = nearest;
    }
    CubeLanes whole;
    for (int i = 0; i < count; ++i) whole.sums[i] = joined(a[i]);
    whole.nearest = joined(closest);
    return whole;
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

  void add(const CubeLanes& a, float m) {
    float s[16];
    sum_lanes(a.sums, s);
    f_high += s[0];
    g_change += m * s[1];
    for (int i = 0; i < 3; ++i) g[i] -= m * s[2 + i];
    f_low += s[5];
    if (!(largest_lane(a.nearest) < 0.99F)) touches = true;
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
    out.add(cube.template lanes_of<Exponent>(group, groups, exponent),
            static_cast<float>(Exponent > 0 ? Exponent : exponent));
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
    alignas(64) float listed[most_near * floats_per_group];
    int count = 0;
    float nearness = 0;
    for (int k = 0; k < groups; ++k) nearness = max_of(nearness, cube.nearness(group + k * floats_per_group));
    const float near_from = root_of(nearness) / far_distances;
    CubeLanes of_far;
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      const CubeLanes here = cube.template lanes_of<Exponent>(group, 1, exponent);
      if (count < most_near && !(largest_lane(here.nearest) < near_from)) {
        __builtin_memcpy(listed + count++ * floats_per_group, group, floats_per_group * sizeof(float));
        continue;
      }
      for (int i = 0; i < CubeTerms::count; ++i) of_far.sums[i] += here.sums[i];
      of_far.nearest = larger(of_far.nearest, here.nearest);
    }
    far.add(of_far, m);
    for (int octant = 0; octant < 8; ++octant)
      near[octant].add(octants[octant].template lanes_of<Exponent>(listed, count, exponent), m);
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
