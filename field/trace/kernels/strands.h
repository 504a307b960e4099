// The angle from the directions of strands [Zanni et al. 2015, eq. 15], along a ray. Part of block_kernels_<set>.cpp.

// A number and its derivatives along some directions.
template <int Slopes>
struct Along {
  float value = 0, slope[Slopes] = {};

  friend Along operator+(Along a, const Along& b) {
    a.value += b.value;
    for (int i = 0; i < Slopes; ++i) a.slope[i] += b.slope[i];
    return a;
  }
  friend Along operator*(const Along& a, const Along& b) {
    Along product{a.value * b.value, {}};
    for (int i = 0; i < Slopes; ++i) product.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
    return product;
  }
};

template <int Slopes>
struct AlongLanes {
  V16 value{}, slope[Slopes] = {};
};

// The monomials 1, x, y, z, xx, yy, zz, xy, xz, yz at p.
template <int Slopes>
struct Quadratic {
  Along<Slopes> m[quadratic_monomials];
  Quadratic(const float p[3], const float (&directions)[Slopes][3]) {
    Along<Slopes> x[3];
    for (int k = 0; k < 3; ++k) {
      x[k].value = p[k];
      for (int i = 0; i < Slopes; ++i) x[k].slope[i] = directions[i][k];
    }
    m[0].value = 1;
    for (int k = 0; k < 3; ++k) {
      m[1 + k] = x[k];
      m[4 + k] = x[k] * x[k];
    }
    m[7] = x[0] * x[1], m[8] = x[0] * x[2], m[9] = x[1] * x[2];
  }
  // 16 quadratics, whose coefficients are `stride` apart.
  AlongLanes<Slopes> of(const float* coefficients, int stride) const {
    AlongLanes<Slopes> sum;
    for (int k = 0; k < quadratic_monomials; ++k) {
      const V16 c = load(coefficients + k * stride);
      sum.value += c * m[k].value;
      for (int i = 0; i < Slopes; ++i) sum.slope[i] += c * m[k].slope[i];
    }
    return sum;
  }
};

// Strands in lanes: f and u, the direction, of length 1 or 0. A strand whose mean direction has the length c turns by
// rho = n / d sqrt(1 - c^2) / c at most, d the distance, as its segments' share of it changes.
template <int Slopes>
struct StrandLanes {
  alignas(64) float sum[4][most_strands];  // f and sum f_s u_s, then f and u
  alignas(64) float sum_slope[Slopes][4][most_strands];
  alignas(64) float inverse2[most_strands];  // 1 / d^2
  alignas(64) float turned[most_strands];    // sqrt(1 - c^2) / c
  int count = 0;
  float field = 0;                               // of all that are listed
  float points = 0, point_bend = 0;              // of points: sums of f and of f b
  Along<Slopes> numerator, denominator, before;  // over pairs; the field of those before

  // Adds the rests, turns sums into directions.
  void make_directions(const StrandLevel& level, const Quadratic<Slopes>& at) {
    const int stride = (count + lanes - 1) / lanes * lanes;
    V16 totals[12] = {};
    for (int b = 0; b < stride; b += lanes) add_rests(level, at, b, stride, totals);
    float t[16];
    sum_lanes(totals, t);
    field = t[0];
  }

  void add_rests(const StrandLevel& level, const Quadratic<Slopes>& at, int b, int stride, V16 (&totals)[12]) {
    AlongLanes<Slopes> s[4];
    for (int k = 0; k < 4; ++k) {
      s[k] = at.of(level.rest + k * stride + b, 4 * stride);
      s[k].value += load(sum[k] + b);
      for (int i = 0; i < Slopes; ++i) s[k].slope[i] += load(sum_slope[i][k] + b);
    }
    const auto counts = s[0].value > 0.0F;
    V16 size2{};
    for (int k = 0; k < 4; ++k) {
      s[k].value = counts ? s[k].value : V16{};
      for (int i = 0; i < Slopes; ++i) s[k].slope[i] = counts ? s[k].slope[i] : V16{};
      if (k > 0) size2 += s[k].value * s[k].value;
    }
    const V16 inverse = size2 > 0.0F ? 1.0F / root_of(size2) : V16{};
    for (int k = 1; k < 4; ++k) s[k].value = s[k].value * inverse;
    for (int i = 0; i < Slopes; ++i) {
      V16 along{};
      for (int k = 1; k < 4; ++k) along += s[k].value * s[k].slope[i];
      for (int k = 1; k < 4; ++k) s[k].slope[i] = (s[k].slope[i] - s[k].value * along) * inverse;
    }
    const V16 near = larger(load(inverse2 + b), splat(level.far_inverse2));
    const V16 f = s[0].value, ff = f * f, c2 = larger(splat(0.0025F), size2 / larger(ff, splat(1e-37F)));
    const V16 turned2 = size2 > 0.0F ? larger(V16{}, 1.0F / c2 - 1.0F) : V16{};
    const V16 turn = root_of(turned2);
    __builtin_memcpy(inverse2 + b, &near, sizeof near);
    __builtin_memcpy(turned + b, &turn, sizeof turn);
    totals[0] += f;
    for (int k = 0; k < 4; ++k) {
      __builtin_memcpy(sum[k] + b, &s[k].value, sizeof(V16));
      for (int i = 0; i < Slopes; ++i) __builtin_memcpy(sum_slope[i][k] + b, &s[k].slope[i], sizeof(V16));
    }
  }

  // One more strand in the sum of f_i f_j over pairs.
  void add_pairs(const Along<Slopes>& f) {
    denominator = denominator + f * before;
    before = before + f;
  }
  void add_all_pairs() {
    for (int i = 0; i < count; ++i) {
      Along<Slopes> f{sum[0][i], {}};
      for (int k = 0; k < Slopes; ++k) f.slope[k] = sum_slope[k][0][i];
      add_pairs(f);
    }
  }

  // sum_j f_j (u_j . u)^8 over lanes of fields and directions, with what they and u change.
  struct Angles {
    V16 value{}, slope[Slopes] = {};
    void add(const V16 (&u)[3], const float (&own)[3], const float (&own_slope)[Slopes][3], const V16& f,
             const V16 (&f_slope)[Slopes], const V16 (&turns)[Slopes]) {
      const V16 g = u[0] * own[0] + u[1] * own[1] + u[2] * own[2], g2 = g * g, g4 = g2 * g2, g8 = g4 * g4;
      const V16 steep = f * (8.0F * g4 * g2 * g);
      value += f * g8;
      for (int i = 0; i < Slopes; ++i) {
        const float* d = own_slope[i];
        slope[i] += f_slope[i] * g8 + steep * (turns[i] + u[0] * d[0] + u[1] * d[1] + u[2] * d[2]);
      }
    }
  };

  // sum of f_i f_j (u_i . u_j)^8 over pairs of strands, and of strands and the axes that stand for the far ones.
  void add_angles(const StrandLevel& level, const AlongLanes<Slopes> (&far)[3]) {
    constexpr Index16 lane{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    V16 totals[12] = {};
    for (int j = 0; j < count; ++j) {
      const float own[3] = {sum[1][j], sum[2][j], sum[3][j]};
      float own_slope[Slopes][3];
      for (int i = 0; i < Slopes; ++i)
        for (int k = 0; k < 3; ++k) own_slope[i][k] = sum_slope[i][1 + k][j];
      Angles angles;
      V16 f_slope[Slopes], turns[Slopes];
      for (int b = 0; b <= j; b += lanes) {
        const V16 u[3] = {load(sum[1] + b), load(sum[2] + b), load(sum[3] + b)};
        const auto earlier = lane < j - b;
        for (int i = 0; i < Slopes; ++i) {
          const auto& d = sum_slope[i];
          f_slope[i] = earlier ? load(d[0] + b) : V16{};
          turns[i] = load(d[1] + b) * own[0] + load(d[2] + b) * own[1] + load(d[3] + b) * own[2];
        }
        angles.add(u, own, own_slope, earlier ? load(sum[0] + b) : V16{}, f_slope, turns);
      }
      for (V16& t : turns) t = V16{};
      for (int k = 0; k < 3; ++k) {
        const float* axes = level.axes + k * lanes;
        const V16 u[3] = {load(axes), load(axes + tensor_floats), load(axes + 2 * tensor_floats)};
        angles.add(u, own, own_slope, far[k].value, far[k].slope, turns);
      }
      totals[0] += angles.value * sum[0][j];
      for (int i = 0; i < Slopes; ++i) totals[1 + i] += angles.slope[i] * sum[0][j] + angles.value * sum_slope[i][0][j];
    }
    float t[16];
    sum_lanes(totals, t);
    numerator.value = t[0];
    for (int i = 0; i < Slopes; ++i) numerator.slope[i] = t[1 + i];
  }
};

template <int Slopes>
struct StrandProbe {
  V16 p[3];
  float direction[Slopes][3];
};

// Sums over the groups of one strand: f and sum f_s u_s, the same of slopes without the factor -m, the nearest.
template <int Exponent, int Slopes>
inline void add_strand_groups(const float* group, const float* direction, int groups, int exponent,
                              const StrandProbe<Slopes>& probe, float (&s)[16], float& inverse2) {
  static_assert(Slopes == 1 || Slopes == 3);
  V16 a[12] = {}, more[4] = {}, nearest{};
  for (int k = 0; k < groups; ++k, group += floats_per_group, direction += 3 * lanes) {
    const V16 dx = probe.p[0] - load(group), dy = probe.p[1] - load(group + 16), dz = probe.p[2] - load(group + 32);
    const V16 inv = 1.0F / (dx * dx + dy * dy + dz * dz);
    const V16 share = load(group + 48), w = field_of<Exponent>(share, load(group + 64), inv, exponent), w2 = w * inv;
    const V16 u[3] = {load(direction), load(direction + 16), load(direction + 32)};
    nearest = larger(nearest, share > 0.0F ? inv : V16{});
    a[0] += w;
    for (int i = 0; i < 3; ++i) a[1 + i] += w * u[i];
    for (int i = 0; i < Slopes; ++i) {
      const float* e = probe.direction[i];
      const V16 slope = w2 * (dx * e[0] + dy * e[1] + dz * e[2]);
      V16* to = i < 2 ? a + 4 + 4 * i : more;
      to[0] += slope;
      for (int j = 0; j < 3; ++j) to[1 + j] += slope * u[j];
    }
  }
  sum_lanes(a, s);
  if constexpr (Slopes > 1) {
    V16 rest[12] = {more[0], more[1], more[2], more[3]};
    float t[16];
    sum_lanes(rest, t);
    for (int i = 0; i < 4; ++i) s[12 + i] = t[i];
  }
  inverse2 = largest_lane(nearest);
}

template <int Exponent, int Slopes>
inline void add_near_strands(const FieldLevel& level, int exponent, const StrandProbe<Slopes>& probe,
                             StrandLanes<Slopes>& out) {
  const StrandLevel& strands = *level.strands;
  const float *group = level.sources, *direction = strands.directions;
  const float m = static_cast<float>(exponent);
  out.count = strands.count;
  for (int j = 0; j < (out.count + lanes - 1) / lanes * lanes; ++j) {
    const int groups = j < out.count ? strands.groups[j] : 0;
    float s[16] = {};
    out.inverse2[j] = 0;
    if (groups > 0) add_strand_groups<Exponent>(group, direction, groups, exponent, probe, s, out.inverse2[j]);
    group += groups * floats_per_group;
    direction += groups * 3 * lanes;
    for (int k = 0; k < 4; ++k) {
      out.sum[k][j] = s[k];
      for (int i = 0; i < Slopes; ++i) out.sum_slope[i][k][j] = -m * s[4 + 4 * i + k];
    }
  }
}

// Points are strands by themselves, without a direction.
template <int Slopes>
inline void add_points(const FieldLevel& level, int degree, const StrandProbe<Slopes>& probe,
                       StrandLanes<Slopes>& out) {
  const float* group = point_sources(level);
  const float m = static_cast<float>(degree - 1);
  for (int k = 0; k < level.point_groups; ++k, group += floats_per_group) {
    const V16 dx = probe.p[0] - load(group), dy = probe.p[1] - load(group + 16), dz = probe.p[2] - load(group + 32);
    const V16 inv = 1.0F / (dx * dx + dy * dy + dz * dz),
              w = field_of<0>(load(group + 48), load(group + 64), inv, degree - 1);
    for (int i = 0; i < lanes; ++i) {
      if (!(w[i] > 0)) continue;
      Along<Slopes> f{w[i], {}};
      for (int j = 0; j < Slopes; ++j) {
        const float* e = probe.direction[j];
        f.slope[j] = -m * w[i] * inv[i] * (dx[i] * e[0] + dy[i] * e[1] + dz[i] * e[2]);
      }
      out.add_pairs(f);
      out.points += w[i];
      out.point_bend += w[i] * inv[i];
    }
  }
}

// What a place sees of the strands, with derivatives along some directions.
template <int Slopes>
struct StrandsAt {
  StrandLanes<Slopes> near;
  AlongLanes<Slopes> far[3];  // StrandLevel::far

  StrandsAt(const FieldLevel& level, int degree, const float p[3], const float (&directions)[Slopes][3]) {
    StrandProbe<Slopes> probe{{splat(p[0]), splat(p[1]), splat(p[2])}, {}};
    for (int i = 0; i < Slopes; ++i)
      for (int k = 0; k < 3; ++k) probe.direction[i][k] = directions[i][k];
    const Quadratic<Slopes> at(p, directions);
    if (degree == 4) add_near_strands<4>(level, degree, probe, near);
    else add_near_strands<0>(level, degree, probe, near);
    near.make_directions(*level.strands, at);
    for (int k = 0; k < 3; ++k) far[k] = at.of(level.strands->far + k * lanes, tensor_floats);
    near.before = sum_of_far(0);
    near.add_all_pairs();
    add_points(level, degree, probe, near);
  }

  // After the 45 axes: the field of the far strands, and over their pairs, see StrandLevel::far.
  Along<Slopes> sum_of_far(int k) const {
    const int lane = 13 + k;
    Along<Slopes> s{far[2].value[lane], {}};
    for (int i = 0; i < Slopes; ++i) s.slope[i] = far[2].slope[i][lane];
    return s;
  }
};
