// One strand as a cube sees it, and its share of a tensor of many. Part of block_kernels_<set>.cpp.

// 0 for those that are left out.
inline V16 weights_of(const float* weights, unsigned left_out) {
  if (left_out == 0) return load(weights);
  alignas(64) float left[lanes];
  for (int i = 0; i < lanes; ++i) left[i] = left_out >> i & 1 ? 0.0F : weights[i];
  return load(left);
}

// Of one strand, at the places where a cube is probed: f and sum f_s u_s; how much a quadratic may be off.
void strand_samples(const StrandQuery& query, StrandSamples& out) {
  const int m = query.exponent;
  V16 error{}, nearest{};
  for (int at = 0; at < strand_places; ++at) {
    float p[3];
    for (int i = 0; i < 3; ++i) p[i] = query.center[i] + query.half * strand_place[at][i];
    const float* group = query.groups;
    V16 a[12] = {};
    for (int k = 0; k < query.count; ++k, group += floats_per_strand_group) {
      const V16 dx = p[0] - load(group), dy = p[1] - load(group + 16), dz = p[2] - load(group + 32);
      const V16 inv = 1.0F / (dx * dx + dy * dy + dz * dz);
      const V16 weight = weights_of(group + 48, query.left_out != nullptr ? query.left_out[k] : 0U);
      const V16 w = select(weight > 0.0F, weight * inverse_power<0>(inv, m), V16{});
      a[0] += w;
      a[1] += w * load(group + 64);
      a[2] += w * load(group + 80);
      a[3] += w * load(group + 96);
      if (at == 0) {
        error += w * inv * root_of(inv);
        nearest = larger(nearest, select(weight > 0.0F, inv, V16{}));
      }
    }
    float s[16];
    sum_lanes(a, s);
    for (int i = 0; i < 4; ++i) out.sums[at][i] = s[i];
  }
  V16 a[12] = {error};
  float s[16];
  sum_lanes(a, s);
  const float radius = 1.7321F * query.half;
  out.error = s[0] * radius * radius * radius;
  out.ratio = radius * root_of(largest_lane(nearest));
}

// Adds f u^8, f, f^2 and f^2 with a direction of one strand to tensors at the places, a place in each lane; not where f
// is no number.
void add_strand(const StrandSamples& samples, float* tensors) {
  V16 s[4];
  for (int k = 0; k < 4; ++k) {
    alignas(64) float at_places[lanes] = {};
    for (int at = 0; at < strand_places; ++at) at_places[at] = samples.sums[at][k];
    s[k] = load(at_places);
  }
  const V16 f = s[0], size2 = s[1] * s[1] + s[2] * s[2] + s[3] * s[3];
  const auto finite = f - f == 0.0F, directed = finite & (size2 > 0.0F);
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
      *to++ = select(directed, f * (power[0][i] * power[1][j] * power[2][8 - i - j]), V16{});
  *to++ = select(finite, f, V16{});
  *to++ = select(finite, f * f, V16{});
  *to++ = select(directed, f * f, V16{});
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
