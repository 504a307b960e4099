// The share of the range of angles from the directions of strands [Zanni et al. 2015, eq. 15], at sixteen places of a
// cube. Part of block_kernels_<set>.cpp.

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

// One strand: f_i and its direction u_i, of length 1 or 0. N = sum f_i f_j (u_i . u_j)^8 over pairs has the derivatives
// u_i . turn_i by f_i and 8 f_i turn_i by u_i, where turn_i is the sum of f_j (u_i . u_j)^7 u_j over all others.
struct Strand16 {
  Slopes16 f, u[3];
  V16 turn[3] = {};

  // u_i . v, of vectors or of one for all places.
  template <class T>
  V16 along(const T (&v)[3]) const {
    return u[0].value * v[0] + u[1].value * v[1] + u[2].value * v[2];
  }
  // Adds f (u . b.u)^7 u to the turn of another.
  void turn_other(Strand16& b) const {
    const V16 to[3] = {b.u[0].value, b.u[1].value, b.u[2].value};
    const V16 steep = f.value * power_of(along(to), 7);
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

// The symmetric tensor sum f u^8 over strands (field-maths 7), whose components are those of StrandLevel::far.
struct Tensor16 {
  V16 of[tensor_components] = {};

  static constexpr int component(int i, int j) { return i * (19 - i) / 2 + j; }

  Tensor16& operator+=(const Tensor16& b) {
    for (int k = 0; k < tensor_components; ++k) of[k] += b.of[k];
    return *this;
  }
};

// Of the direction of a strand: the powers of its components.
template <int Degree>
struct DirectionPowers {
  V16 of[3][Degree + 1];

  explicit DirectionPowers(const Strand16& s) {
    for (int k = 0; k < 3; ++k) {
      of[k][0] = splat(1);
      for (int i = 1; i <= Degree; ++i) of[k][i] = of[k][i - 1] * s.u[k].value;
    }
  }
};

inline void add_strand(const Strand16& s, Tensor16& to) {
  const DirectionPowers<8> u(s);
  for (int i = 0; i <= 8; ++i) {
    const V16 first = s.f.value * u.of[0][i];
    for (int j = 0; i + j <= 8; ++j) to.of[Tensor16::component(i, j)] += first * u.of[1][j] * u.of[2][8 - i - j];
  }
}

// Adds sum f_j (u_j . u)^7 u_j over the strands of a tensor to the turn of one.
inline void turn_by(const Tensor16& t, Strand16& s) {
  const DirectionPowers<7> u(s);
  for (int i = 0; i <= 7; ++i)
    for (int j = 0; i + j <= 7; ++j) {
      const V16 product = times_in_seventh.of[i][j] * u.of[0][i] * u.of[1][j] * u.of[2][7 - i - j];
      s.turn[0] += product * t.of[Tensor16::component(i + 1, j)];
      s.turn[1] += product * t.of[Tensor16::component(i, j + 1)];
      s.turn[2] += product * t.of[Tensor16::component(i, j)];
    }
}

// The strands that are the strongest at some place.
struct Strongest {
  int of[lanes], count = 0;

  Strongest(const Strand16* strands, int all) {
    V16 most{}, which = splat(-1);
    for (int j = 0; j < all; ++j) {
      const auto stronger = strands[j].f.value > most;
      which = select(stronger, splat(static_cast<float>(j)), which);
      most = select(stronger, strands[j].f.value, most);
    }
    alignas(64) float at_places[lanes];
    __builtin_memcpy(at_places, &which, sizeof which);
    for (const float at : at_places)
      if (at >= 0 && !holds(static_cast<int>(at))) of[count++] = static_cast<int>(at);
  }
  bool holds(int strand) const {
    for (int i = 0; i < count; ++i)
      if (of[i] == strand) return true;
    return false;
  }
};

// Finds what turns each strand: all others by one tensor, less its own part, where that is not most of it at any place,
// so that no digits are lost.
inline void find_turns(Strand16* strands, int count, Tensor16 others, Tensor16& near) {
  const Strongest strongest(strands, count);
  Tensor16 strong;
  near = {};
  for (int j = 0; j < count; ++j) add_strand(strands[j], strongest.holds(j) ? strong : near);
  others += near;
  for (int i = 0; i < strongest.count; ++i) {
    Strand16& s = strands[strongest.of[i]];
    turn_by(others, s);
    for (int j = 0; j < strongest.count; ++j)
      if (j != i) strands[strongest.of[j]].turn_other(s);
  }
  others += strong;
  near += strong;
  for (int j = 0; j < count; ++j) {
    if (strongest.holds(j)) continue;
    Strand16& s = strands[j];
    turn_by(others, s);
    for (int k = 0; k < 3; ++k) s.turn[k] -= s.f.value * s.u[k].value;
  }
}

// sum f_i f_j over pairs, one strand after the other.
struct PairsOfFields {
  Slopes16 before, sum;
  void add(const Slopes16& f) {
    sum = sum + f * before;
    before = before + f;
  }
};

// Points are strands by themselves, without a direction.
inline void add_points(const FieldLevel& level, int degree, const Places16& at, PairsOfFields& pairs) {
  const float* group = point_sources(level);
  const float m = static_cast<float>(degree - 1);
  for (int k = 0; k < level.point_groups; ++k, group += floats_per_group)
    for (int i = 0; i < lanes; ++i) {
      if (!(group[48 + i] > 0)) continue;
      const V16 d[3] = {at.p[0] - group[i], at.p[1] - group[16 + i], at.p[2] - group[32 + i]};
      const V16 inv = 1.0F / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      Slopes16 f{field_of<0>(splat(group[48 + i]), splat(group[64 + i]), inv, degree - 1), {}};
      for (int e = 0; e < 3; ++e) f.slope[e] = -m * f.value * inv * d[e];
      pairs.add(f);
    }
}

void strand_shares(const FieldLevel& level, int degree, const float (&center)[3], float half, float* memory,
                   StrandShares& out) {
  const StrandLevel& seen = *level.strands;
  auto* const strands = static_cast<Strand16*>(static_cast<void*>(memory));
  const Places16 at(center, half);
  if (degree == 4) find_strands<4>(level, degree, at, strands);
  else find_strands<0>(level, degree, at, strands);
  // Twice N over pairs of which one is among the near strands.
  Tensor16 far, near;
  for (int k = 0; k < tensor_components; ++k) far.of[k] = at.quadratic(seen.far + k, tensor_floats).value;
  find_turns(strands, seen.count, far, near);
  Slopes16 turned{};
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j) {
      const int k = Tensor16::component(i, j);
      const Slopes16 of_far = at.quadratic(seen.far + k, tensor_floats);
      const V16 of_near = times_in_eighth.of[i][j] * near.of[k];
      turned.value += of_near * of_far.value;
      for (int e = 0; e < 3; ++e) turned.slope[e] += 2.0F * of_near * of_far.slope[e];
    }
  PairsOfFields pairs;
  pairs.before = at.quadratic(seen.far + far_sum, tensor_floats);
  for (int j = 0; j < seen.count; ++j) {
    const Strand16& s = strands[j];
    pairs.add(s.f);
    const V16 by_f = s.along(s.turn), by_u = 8.0F * s.f.value;
    turned.value += s.f.value * by_f;
    for (int e = 0; e < 3; ++e) {
      V16 by_turn{};
      for (int k = 0; k < 3; ++k) by_turn += s.turn[k] * s.u[k].slope[e];
      turned.slope[e] += 2.0F * (by_f * s.f.slope[e] + by_u * by_turn);
    }
  }
  add_points(level, degree, at, pairs);
  const Slopes16 above = turned + at.quadratic(seen.far + far_turned_pairs, tensor_floats),
                 below = pairs.sum + pairs.sum + at.quadratic(seen.far + far_pairs, tensor_floats);
  // One strand alone: any angle will do, see directional_alpha.h.
  const auto some = below.value > 1e-36F;
  const V16 inverse = select(some, 1.0F / below.value, V16{});
  const V16 share = select(some, smaller(splat(1), larger(V16{}, above.value * inverse)), splat(1));
  __builtin_memcpy(out.share, &share, sizeof share);
  for (int e = 0; e < 3; ++e) {
    const V16 slope = (above.slope[e] - share * below.slope[e]) * inverse;
    __builtin_memcpy(out.slope[e], &slope, sizeof slope);
  }
}
