// One strand as a cube sees it, and its share of a tensor of many. Part of block_kernels_<set>.cpp.

// What is left of the sums over nodes where pieces count as quadratics: binom(n + 2, 3) q^3 of each, q the radius of
// the cube over its distance [taylor_remainder.h]; where they count by two nodes L^4 / 4320 times the fourth derivative
// along a piece of length L [Abramowitz and Stegun 25.4.30], of which d^-n gives n (n + 1) (n + 2) (n + 3) d^-4, and a
// radius that changes some more.
struct StrandErrors {
  float radius, quadratic, rule;

  explicit StrandErrors(const StrandQuery& query) : radius(1.7321F * query.half) {
    const auto n = static_cast<float>(query.exponent);
    quadratic = n * (n + 1) * (n + 2) / 6;
    rule = 2 * n * (n + 1) * (n + 2) * (n + 3) / 4320;  // of both nodes
  }
  V16 of_quadratic(V16 w, V16 ratio) const { return quadratic * w * (ratio * ratio * ratio); }
  V16 of_rule(V16 w, V16 length, V16 taper, V16 distance) const {
    const V16 spread = length / larger(distance - radius, splat(1e-30F)) + taper, square = spread * spread;
    return rule * w * (square * square);
  }
};

// The nodes of a group and their fields at a place; unused lanes have none.
struct NodesAt {
  V16 weight, distance2, w;
  NodesAt(const float* group, const StrandQuery& query, const float (&p)[3]) : weight(load(group + 48)) {
    const V16 dx = p[0] - load(group), dy = p[1] - load(group + 16), dz = p[2] - load(group + 32);
    distance2 = dx * dx + dy * dy + dz * dz;
    w = select(weight > 0.0F, weight * inverse_power<0>(1.0F / distance2, query.exponent), V16{});
  }
};

// The lanes of a group whose pieces count one by one.
inline unsigned near_nodes(const NodesAt& at, const float* group, const StrandQuery& query,
                           const StrandErrors& errors) {
  const V16 distance = root_of(at.distance2), ratio = errors.radius / distance;
  const auto far = (ratio < query.largest_ratio) & (errors.of_quadratic(at.w, ratio) < query.allowed) &
                   (errors.of_rule(at.w, load(group + 112), load(group + 128), distance) < query.allowed);
  const unsigned near = ~lane_bits(far) & lane_bits(at.weight > 0.0F);
  return near | (near & 0x5555U) << 1 | (near >> 1 & 0x5555U);
}

// 0 for those that are left out.
inline V16 without(unsigned left_out, V16 v) {
  if (left_out == 0) return v;
  alignas(64) float left[lanes];
  __builtin_memcpy(left, &v, sizeof v);
  for (int i = 0; i < lanes; ++i)
    if (left_out >> i & 1) left[i] = 0;
  return load(left);
}

// f and sum f_s u_s at one place.
inline void sum_nodes_at(const float (&p)[3], const StrandQuery& query, float (&sums)[4]) {
  V16 sum[12] = {};
  const float* group = query.groups;
  for (int k = 0; k < query.count; ++k, group += floats_per_strand_group) {
    const V16 w = without(query.near != nullptr ? query.near[k] : 0U, NodesAt(group, query, p).w);
    sum[0] += w;
    for (int i = 0; i < 3; ++i) sum[1 + i] += w * load(group + 64 + 16 * i);
  }
  float s[16];
  sum_lanes(sum, s);
  for (int i = 0; i < 4; ++i) sums[i] = s[i];
}

void strand_in_middle(const StrandQuery& query, StrandInMiddle& out) {
  const StrandErrors errors(query);
  V16 a[12] = {}, largest{};
  for (int k = 0; k < query.count; ++k) {
    const float* const group = query.groups + k * floats_per_strand_group;
    const NodesAt at(group, query, query.center);
    const unsigned near = query.near != nullptr ? near_nodes(at, group, query, errors) : 0U;
    if (query.near != nullptr) query.near[k] = static_cast<unsigned short>(near);
    const V16 ratio = without(near, select(at.weight > 0.0F, errors.radius / root_of(at.distance2), V16{}));
    const V16 w = without(near, at.w);
    a[0] += w;
    a[1] += errors.of_quadratic(w, ratio);
    largest = larger(largest, ratio);
  }
  float s[16];
  sum_lanes(a, s);
  out = {.field = s[0], .error = s[1], .ratio = largest_lane(largest)};
}

// At the places where a cube is probed.
void strand_samples(const StrandQuery& query, StrandSamples& out) {
  for (int at = 0; at < strand_places; ++at) {
    float p[3];
    for (int i = 0; i < 3; ++i) p[i] = query.center[i] + query.half * strand_place[at][i];
    sum_nodes_at(p, query, out.sums[at]);
  }
}

// Adds f u^8, f, f^2 and f^2 with a direction of one strand to tensors at the places, each by its weight, a place in
// each lane; not where f is no number.
void add_strand(const StrandSamples& samples, const TensorWeights& weights, float* tensors) {
  V16 s[4];
  for (int k = 0; k < 4; ++k) {
    alignas(64) float at_places[lanes] = {};
    for (int at = 0; at < strand_places; ++at) at_places[at] = samples.sums[at][k];
    s[k] = load(at_places);
  }
  const V16 f = s[0], by_f = select(f > 0.0F, 1.0F / f, V16{});  // squares of weak fields vanish in floats
  for (int k = 1; k < 4; ++k) s[k] = s[k] * by_f;
  const V16 size2 = s[1] * s[1] + s[2] * s[2] + s[3] * s[3];
  const auto finite = f - f == 0.0F, directed = finite & (size2 > least_direction_squared);
  const V16 inverse = select(directed, 1.0F / root_of(size2), V16{});
  V16 power[3][9];  // of the components of u
  for (int k = 0; k < 3; ++k) {
    power[k][0] = splat(1);
    for (int i = 1; i <= 8; ++i) power[k][i] = power[k][i - 1] * (s[1 + k] * inverse);
  }
  V16 rows[tensor_floats];  // x^i y^j z^(8-i-j), j faster; the sums
  V16* to = rows;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j)
      *to++ = select(directed, weights.directed * f * (power[0][i] * power[1][j] * power[2][8 - i - j]), V16{});
  *to++ = select(finite, weights.all * f, V16{});
  *to++ = select(finite, weights.all * (f * f), V16{});
  *to++ = select(directed, weights.directed * (f * f), V16{});
  for (int part = 0; part < tensor_floats; part += native_lanes) {
    V16 of_part[native_lanes];
    for (int i = 0; i < native_lanes; ++i) of_part[i] = rows[part + i];
    Native columns[lanes];
    find_columns(of_part, columns);
    for (int at = 0; at < strand_places; ++at) {
      float* const sums = tensors + at * tensor_floats + part;
      Native sum;
      __builtin_memcpy(&sum, sums, sizeof sum);
      sum += columns[at];
      __builtin_memcpy(sums, &sum, sizeof sum);
    }
  }
}
