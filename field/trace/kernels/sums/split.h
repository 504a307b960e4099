// Which of some pieces are far from a ball, and the moments of those that are. Part of block_kernels_<set>.cpp.

// The tail sum_{k>P} binom(e+k-1, k) q^k of the series of (1-q)^-e (taylor_remainder.h): its terms fall at least by the
// first ratio, so a geometric series bounds it. `first` is binom(e+P, P+1). Negative: no bound.
template <int FarDegree>
inline V16 series_tail(V16 q, int exponent, float first) {
  const V16 rest = 1.0F - q * (static_cast<float>(exponent + FarDegree + 1) / (FarDegree + 2));
  return select(rest > 0.05F, first * power_of(q, FarDegree + 1) / rest, splat(-1));
}

inline V16 sum_of_sizes(V16 x, V16 y, V16 z) {
  return larger(x, V16{} - x) + larger(y, V16{} - y) + larger(z, V16{} - z);
}

// Of the remainder in the ball about a cube, what sources leave in the cube, `sizes` the largest sum of the sizes of
// their three coordinates, `distance` the least one (cube_remainder.h).
template <int FarDegree>
inline V16 cube_share(V16 sizes, V16 distance) {
  V16 share = splat(1);
  for (int i = remainder_steps - 1; i >= 0; --i)
    share = select(sizes <= remainder_spread[i] * distance, splat(CubeRemainder<FarDegree>::share[i]), share);
  return share;
}

// Where sources of a piece count linearly more towards one end, of which its share is.
inline V16 weight_at(const float* group, float s) {
  const V16 lean = load(group + 208);
  return select(lean > 0.0F, 1.0F - lean, splat(1)) + lean * s;
}
// What that adds to the errors of rules, as a radius that changes does (quadrature.h).
inline V16 widened_by_lean(const float* group, V16 distance) {
  const V16 lean = load(group + 208);
  return 1.0F + select(lean < 0.0F, V16{} - lean, lean) * distance / larger(load(group + 160), splat(1e-30F));
}

struct FarLanes {
  V16 far;               // 1 or 0
  V16 f_error, g_error;  // of lanes that are far
  V16 field, gradient;   // largest over the ball's centre
  V16 distance;          // of the ball's centre, at least
  int nodes = 1;
};

// Distances are lowered by what rounding can do to numbers of the size of the coordinates.
template <int Exponent, int FarDegree>
inline FarLanes far_lanes(const float* group, const FarQuery& query) {
  const int m = Exponent > 0 ? Exponent : query.exponent;
  const float* c = query.center;
  const V16 wx = c[0] - load(group), wy = c[1] - load(group + 16), wz = c[2] - load(group + 32);
  const V16 ax = load(group + 48), ay = load(group + 64), az = load(group + 80);
  const V16 along = (wx * ax + wy * ay + wz * az) * load(group + 96);
  const V16 t = select(along < 0.0F, V16{}, select(along > 1.0F, splat(1), along));
  const V16 dx = wx - ax * t, dy = wy - ay * t, dz = wz - az * t;
  const V16 share = load(group + 112), taper = load(group + 128), tau = load(group + 144), size = load(group + 160);
  const V16 exact = root_of(dx * dx + dy * dy + dz * dz), d = exact - 2e-6F * (query.radius + exact + size);
  const V16 q = query.radius / larger(d, splat(1e-20F)), high = tau / larger(d, splat(1e-20F));
  FarLanes out;
  out.distance = d;
  out.field = share * power_of(high, m);
  out.gradient = static_cast<float>(m) * out.field * high;
  const V16 f_tail = series_tail<FarDegree>(q, m, query.field_series),
            g_tail = series_tail<FarDegree>(q, m + 1, query.gradient_series);
  const V16 in_cube =
      cube_share<FarDegree>(larger(sum_of_sizes(wx, wy, wz), sum_of_sizes(wx - ax, wy - ay, wz - az)), d);
  out.f_error = out.field * f_tail * in_cube;
  out.g_error = out.gradient * g_tail * in_cube;
  V16 far = select(q <= 0.5F, splat(1), V16{});
  far = select(share > 0.0F, far, V16{});  // an unused lane
  far = select(f_tail >= 0.0F, far, V16{});
  far = select(g_tail >= 0.0F, far, V16{});
  far = select(out.f_error <= query.field_budget, far, V16{});
  far = select(out.g_error <= query.gradient_budget, far, V16{});
  if (query.points) {
    out.far = far;
    return out;
  }
  // Gauss-Legendre rules of few nodes at the least distance to the ball (quadrature.h).
  const V16 near = larger(d - query.radius, splat(1e-20F)), near_high = tau / near, ratio = size / near;
  const V16 slope = select(taper < 0.0F, V16{} - taper, taper);
  const V16 widened = 1.0F + slope * near / larger(size * tau, splat(1e-30F));
  V16 scale = share * power_of(near_high, m);
  for (int k = 1; k < m; ++k) scale = scale * widened;
  if (query.some_lean) scale = scale * widened_by_lean(group, near);
  const V16 g_scale = scale * widened * near_high;
  V16 shrink = splat(1);
  for (int nodes = 1; nodes <= query.most_nodes; ++nodes) {
    shrink = shrink * ratio * ratio;
    const V16 f = query.field_rule[nodes] * scale * shrink, g = query.gradient_rule[nodes] * g_scale * shrink;
    V16 fits = select(f <= 0.25F * query.field_budget, far, V16{});
    fits = select(g <= 0.25F * query.gradient_budget, fits, V16{});
    const bool all = !(largest_lane(far - fits) > 0);
    if (!all && nodes < query.most_nodes) continue;
    out.nodes = nodes;
    out.far = fits;
    out.f_error += f;
    out.g_error += g;
    break;
  }
  return out;
}

struct SlightLanes {
  V16 slight = {};                 // 1 or 0
  V16 f_error = {}, g_error = {};  // of lanes that are slight
};

// Near pieces that hardly count anywhere in the ball: their largest field, at the least distance, is their error.
template <int Exponent>
inline SlightLanes slight_lanes(const float* group, const FarQuery& query, const FarLanes& lanes_far) {
  const int m = Exponent > 0 ? Exponent : query.exponent;
  const V16 share = load(group + 112), tau = load(group + 144);
  const V16 d = lanes_far.distance - query.radius, high = tau / larger(d, splat(1e-20F));
  SlightLanes out;
  out.f_error = share * power_of(high, m);
  out.g_error = static_cast<float>(m) * out.f_error * high;
  V16 slight = select(out.f_error <= query.slight_field, 1.0F - lanes_far.far, V16{});
  slight = select(out.g_error <= query.slight_gradient, slight, V16{});
  out.slight = select(share > 0.0F, slight, V16{});
  return out;
}

// In smaller cubes little is slight that is not far.
inline bool is_thin_beside(const float* group, const FarQuery& query) {
  return 6 * largest_lane(load(group + 144)) < query.radius;
}

// Gauss-Legendre rules on [0, 1].
inline constexpr float gauss_position[most_far_nodes + 1][most_far_nodes] = {
    {},
    {0.5F},
    {0.21132487F, 0.78867513F},
    {0.11270167F, 0.5F, 0.88729833F},
    {0.06943184F, 0.33000948F, 0.66999052F, 0.93056816F},
    {0.04691008F, 0.23076534F, 0.5F, 0.76923466F, 0.95308992F}};
inline constexpr float gauss_weight[most_far_nodes + 1][most_far_nodes] = {
    {},
    {1},
    {0.5F, 0.5F},
    {5 / 18.0F, 8 / 18.0F, 5 / 18.0F},
    {0.17392742F, 0.32607258F, 0.32607258F, 0.17392742F},
    {0.11846344F, 0.23931434F, 0.28444444F, 0.23931434F, 0.11846344F}};

template <int Exponent, int FarDegree>
inline void add_far_nodes(const float* group, const FarQuery& query, const FarLanes& lanes_far,
                          MomentSums<FarDegree>& sums) {
  const int m = Exponent > 0 ? Exponent : query.exponent, nodes = lanes_far.nodes;
  const float* c = query.center;
  const V16 x = load(group) - c[0], y = load(group + 16) - c[1], z = load(group + 32) - c[2];
  const V16 ax = load(group + 48), ay = load(group + 64), az = load(group + 80);
  const V16 share = load(group + 112), taper = load(group + 128), tau = load(group + 144);
  const V16 first = select(taper > 0.0F, tau - taper, tau);  // radius at `from`; tau is the larger one
  const float per_half = 1 / query.half;
  for (int k = 0; k < nodes; ++k) {
    const float s = query.points ? 0 : gauss_position[nodes][k];
    const V16 rx = x + ax * s, ry = y + ay * s, rz = z + az * s, radius = first + taper * s;
    const V16 inverse2 = select(lanes_far.far > 0.0F, 1.0F / (rx * rx + ry * ry + rz * rz), V16{});
    const V16 ratio2 = radius * radius * inverse2;
    // w |r|^-m, w = share tau tau(s)^(n-1) for curves of m = n; share tau^m for points
    const V16 lift = query.points ? splat(1) : tau / radius;
    V16 field = gauss_weight[nodes][k] * share * lift * inverse_power<Exponent>(ratio2, m);
    if (query.some_lean) field = field * weight_at(group, s);
    const V16 scale = inverse2 * query.half;
    sums.add(rx * scale, ry * scale, rz * scale, select(lanes_far.far > 0.0F, field, V16{}), radius * per_half);
  }
}

template <int Exponent, int FarDegree>
inline void split_groups(const float* group, int groups, const FarQuery& query, unsigned short* near, FarSums& out) {
  MomentSums<FarDegree> sums;
  V16 totals[12] = {};
  for (int k = 0; k < groups; ++k, group += floats_per_piece_group) {
    const FarLanes lanes_far = far_lanes<Exponent, FarDegree>(group, query);
    const unsigned bits = ~lane_bits(lanes_far.far > 0.0F) & 0xffff;
    near[k] = static_cast<unsigned short>(bits);
    if (query.slight_field > 0 && bits != 0 && is_thin_beside(group, query)) {
      const SlightLanes left_out = slight_lanes<Exponent>(group, query, lanes_far);
      near[k] = static_cast<unsigned short>(bits & ~lane_bits(left_out.slight > 0.0F));
      totals[0] += select(left_out.slight > 0.0F, left_out.f_error, V16{});
      totals[1] += select(left_out.slight > 0.0F, left_out.g_error, V16{});
    }
    if (bits == 0xFFFF) continue;
    totals[0] += select(lanes_far.far > 0.0F, lanes_far.f_error, V16{});
    totals[1] += select(lanes_far.far > 0.0F, lanes_far.g_error, V16{});
    totals[2] += select(lanes_far.far > 0.0F, lanes_far.field, V16{});
    totals[3] += select(lanes_far.far > 0.0F, lanes_far.gradient, V16{});
    add_far_nodes<Exponent, FarDegree>(group, query, lanes_far, sums);
  }
  float s[16];
  sum_lanes(totals, s);
  out.f_error = s[0] * (1 + rounding);
  out.g_error = s[1] * (1 + rounding);
  out.field = s[2] * (1 + rounding);
  out.gradient = s[3] * (1 + rounding);
  sums.write(out.f, out.potential);
}

template <int FarDegree>
inline void split_to_degree(const float* groups, int count, const FarQuery& query, unsigned short* near, FarSums& out) {
  if (query.exponent == 4) split_groups<4, FarDegree>(groups, count, query, near, out);
  else if (query.exponent == 3) split_groups<3, FarDegree>(groups, count, query, near, out);
  else split_groups<0, FarDegree>(groups, count, query, near, out);
}

void far_split(const float* groups, int count, const FarQuery& query, unsigned short* near, FarSums& out) {
  if (query.far_degree == 4) split_to_degree<4>(groups, count, query, near, out);
  else if (query.far_degree == 6) split_to_degree<6>(groups, count, query, near, out);
  else split_to_degree<8>(groups, count, query, near, out);
}
