// The fields and directions of strands at sixteen places of a cube. Part of block_kernels_<set>.cpp.

// Of a strand over its f.
constexpr float least_direction_squared = static_cast<float>(least_direction * least_direction);

// A number at the places, and its derivatives by x, y and z.
struct Slopes16 {
  V16 value{}, slope[3] = {};

  friend Slopes16 operator+(Slopes16 a, const Slopes16& b) {
    a.value += b.value;
    for (int e = 0; e < 3; ++e) a.slope[e] += b.slope[e];
    return a;
  }
  friend Slopes16 operator*(const Slopes16& a, const Slopes16& b) {
    Slopes16 product{a.value * b.value, {}};
    for (int e = 0; e < 3; ++e) product.slope[e] = a.slope[e] * b.value + a.value * b.slope[e];
    return product;
  }
  friend Slopes16 operator*(Slopes16 a, float weight) {
    a.value = a.value * weight;
    for (V16& slope : a.slope) slope = slope * weight;
    return a;
  }
};

// The coordinates of the places.
struct Places16 {
  V16 p[3];

  Places16(const float (&center)[3], float half) {
    for (int k = 0; k < 3; ++k) {
      alignas(64) float of_lane[lanes];
      for (int lane = 0; lane < lanes; ++lane)
        of_lane[lane] = center[k] + half * strand_place[lane < strand_places ? lane : 0][k];
      p[k] = load(of_lane);
    }
  }
  // A quadratic whose coefficients for 1, x, y, z, xx, yy, zz, xy, xz, yz are `stride` apart.
  Slopes16 quadratic(const float* coefficients, int stride) const {
    float c[quadratic_monomials];
    for (int i = 0; i < quadratic_monomials; ++i) c[i] = coefficients[i * stride];
    const V16 x = p[0], y = p[1], z = p[2];
    return {
        c[0] + (c[1] + c[4] * x + c[7] * y + c[8] * z) * x + (c[2] + c[5] * y + c[9] * z) * y + (c[3] + c[6] * z) * z,
        {c[1] + 2 * c[4] * x + c[7] * y + c[8] * z, c[2] + 2 * c[5] * y + c[7] * x + c[9] * z,
         c[3] + 2 * c[6] * z + c[8] * x + c[9] * y}};
  }
};

// One strand: f_i and its direction u_i, of length 1 or 0. N = sum a_ij f_i f_j (u_i . u_j)^8 over pairs, a_ij the mean
// of what being parallel adds to the angles of both, has the derivatives u_i . turn_i by f_i and 8 f_i turn_i by u_i,
// where turn_i is the sum of a_ij f_j (u_i . u_j)^7 u_j over all others.
struct Strand16 {
  Slopes16 f, u[3];
  V16 turn[3] = {};

  // u_i . v, of vectors or of one for all places.
  template <class T>
  V16 along(const T (&v)[3]) const {
    return u[0].value * v[0] + u[1].value * v[1] + u[2].value * v[2];
  }
  // Adds f (u . b.u)^7 u, times a weight, to the turn of another.
  void turn_other(Strand16& b, float weight) const {
    const V16 to[3] = {b.u[0].value, b.u[1].value, b.u[2].value};
    const V16 steep = weight * f.value * power_of(along(to), 7);
    for (int k = 0; k < 3; ++k) b.turn[k] += steep * u[k].value;
  }
};
static_assert(sizeof(Strand16) == floats_per_strand * sizeof(float));

// Sources of one direction: their f, and what it changes by but for a factor of -m.
struct SameDirection {
  float u[3];
  V16 value{}, slope[3] = {};

  template <int Exponent>
  void add(const float* source, int exponent, const Places16& at) {
    const V16 d[3] = {at.p[0] - source[0], at.p[1] - source[16], at.p[2] - source[32]};
    const V16 inv = 1.0F / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const V16 w = field_of<Exponent>(splat(source[48]), splat(source[64]), inv, exponent), w2 = w * inv;
    value += w;
    for (int e = 0; e < 3; ++e) slope[e] += w2 * d[e];
  }

  // To f and sum f_s u_s.
  void add_to(float m, Slopes16 (&s)[4]) const {
    s[0].value += value;
    for (int j = 0; j < 3; ++j) s[1 + j].value += value * u[j];
    for (int e = 0; e < 3; ++e) {
      const V16 change = m * slope[e];
      s[0].slope[e] -= change;
      for (int j = 0; j < 3; ++j) s[1 + j].slope[e] -= change * u[j];
    }
  }
};

// Adds f and sum f_s u_s over the groups of a strand to s. Sources of a segment follow each other, and a direction
// counts once for all of them.
template <int Exponent>
inline void add_strand_groups(const float* group, const float* direction, int groups, int exponent, const Places16& at,
                              Slopes16 (&s)[4]) {
  const auto m = static_cast<float>(exponent);
  SameDirection same{.u = {}};
  for (int k = 0; k < groups; ++k, group += floats_per_group, direction += 3 * lanes)
    for (int i = 0; i < lanes; ++i) {
      if (!(group[48 + i] > 0)) continue;  // not used
      const float u[3] = {direction[i], direction[16 + i], direction[32 + i]};
      if (u[0] != same.u[0] || u[1] != same.u[1] || u[2] != same.u[2]) {
        same.add_to(m, s);
        same = {.u = {u[0], u[1], u[2]}};
      }
      same.add<Exponent>(group + i, exponent, at);
    }
  same.add_to(m, s);
}

inline void set_strand(const Slopes16 (&s)[4], Strand16& out) {
  const auto counts = s[0].value > 0.0F;
  out = {};
  out.f.value = select(counts, s[0].value, V16{});
  for (int e = 0; e < 3; ++e) out.f.slope[e] = select(counts, s[0].slope[e], V16{});
  // Over f, as squares of weak fields vanish in floats.
  const V16 by_f = select(counts, 1.0F / s[0].value, V16{});
  V16 v[3];
  for (int k = 0; k < 3; ++k) v[k] = s[1 + k].value * by_f;
  const V16 size2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const V16 inverse = select(counts & (size2 > least_direction_squared), 1.0F / root_of(size2), V16{});
  for (int k = 0; k < 3; ++k) out.u[k].value = v[k] * inverse;
  for (int e = 0; e < 3; ++e) {
    V16 slope[3], along{};
    for (int k = 0; k < 3; ++k) {
      slope[k] = s[1 + k].slope[e] * by_f;
      along += out.u[k].value * slope[k];
    }
    for (int k = 0; k < 3; ++k) out.u[k].slope[e] = (slope[k] - out.u[k].value * along) * inverse;
  }
}

template <int Exponent>
inline void find_strands(const FieldLevel& level, int exponent, const Places16& at, Strand16* out) {
  const StrandLevel& strands = *level.strands;
  const float *group = level.sources, *direction = strands.directions;
  const int stride = (strands.count + lanes - 1) / lanes * lanes;
  for (int j = 0; j < strands.count; ++j) {
    Slopes16 s[4];
    for (int k = 0; k < 4; ++k) s[k] = at.quadratic(strands.rest + k * stride + j, 4 * stride);
    add_strand_groups<Exponent>(group, direction, strands.groups[j], exponent, at, s);
    set_strand(s, out[j]);
    group += strands.groups[j] * floats_per_group;
    direction += strands.groups[j] * 3 * lanes;
  }
}
