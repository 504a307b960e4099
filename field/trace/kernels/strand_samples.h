// One strand as a cube sees it, and its share of a tensor of many. Part of block_kernels_<set>.cpp.

// The 45 components x^i y^j z^k of a symmetric tensor of degree 8, three lanes left over. Powers above 8 are 0, and so
// are the lanes that ask for them.
struct TensorLayout {
  alignas(64) int x[tensor_floats], y[tensor_floats], z[tensor_floats];
};
inline constexpr TensorLayout tensor_layout = [] {
  TensorLayout l{};
  int at = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j, ++at) {
      l.x[at] = i;
      l.y[at] = j;
      l.z[at] = 8 - i - j;
    }
  for (; at < tensor_floats; ++at) l.x[at] = l.y[at] = l.z[at] = 9;
  return l;
}();

inline Index16 load_index(const int* p) {
  Index16 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

// x^0 .. x^8 in lanes.
inline V16 powers_of(float x) {
  alignas(64) float v[lanes] = {1};
  for (int i = 1; i <= 8; ++i) v[i] = v[i - 1] * x;
  return load(v);
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
      V16 weight = load(group + 48);
      if (query.left_out != nullptr && query.left_out[k] != 0)
        for (int i = 0; i < lanes; ++i) weight[i] = query.left_out[k] >> i & 1 ? 0.0F : weight[i];
      const V16 w = weight > 0.0F ? weight * inverse_power<0>(inv, m) : V16{};
      a[0] += w;
      a[1] += w * load(group + 64);
      a[2] += w * load(group + 80);
      a[3] += w * load(group + 96);
      if (at == 0) {
        error += w * inv * root_of(inv);
        nearest = larger(nearest, weight > 0.0F ? inv : V16{});
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

// Adds f u^8, f, f^2 and f^2 with a direction of one strand to a tensor.
void add_strand(const float sums[4], float* tensor) {
  const float size2 = sums[1] * sums[1] + sums[2] * sums[2] + sums[3] * sums[3], f = sums[0];
  tensor[45] += f;
  tensor[46] += f * f;
  if (!(size2 > 0)) return;
  tensor[47] += f * f;
  const float inverse = 1 / root_of(size2);
  const V16 px = powers_of(sums[1] * inverse), py = powers_of(sums[2] * inverse), pz = powers_of(sums[3] * inverse);
  for (int k = 0; k < 3; ++k) {
    const V16 component = __builtin_shuffle(px, load_index(tensor_layout.x + lanes * k)) *
                          __builtin_shuffle(py, load_index(tensor_layout.y + lanes * k)) *
                          __builtin_shuffle(pz, load_index(tensor_layout.z + lanes * k));
    for (int i = 0; i < lanes; ++i) tensor[k * lanes + i] += f * component[i];
  }
}
