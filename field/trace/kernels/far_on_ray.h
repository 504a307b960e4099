// The far field at a point and along a ray. Part of block_kernels_<set>.cpp.

// Monomials of degree <= 4, in the order of far_field.h.
template <class T>
inline void fill_monomials(T x, T y, T z, T (&m)[far_monomials]) {
  m[0] = T{} + 1.0F;
  m[1] = x, m[2] = y, m[3] = z;
  m[4] = x * x, m[5] = x * y, m[6] = x * z, m[7] = y * y, m[8] = y * z, m[9] = z * z;
  for (int i = 0; i < 6; ++i) m[10 + i] = x * m[4 + i];
  for (int i = 0; i < 3; ++i) m[16 + i] = y * m[7 + i];
  m[19] = z * m[9];
  for (int i = 0; i < 10; ++i) m[20 + i] = x * m[10 + i];
  for (int i = 0; i < 4; ++i) m[30 + i] = y * m[16 + i];
  m[34] = z * m[19];
}

// (f, Gx, Gy, Gz) of the far field at a point.
inline V4 far_at(const FieldLevel& b, float x, float y, float z) {
  float m[far_monomials];
  fill_monomials<float>(x, y, z, m);
  V4 sum[5] = {};  // five independent chains of additions
  for (int i = 0; i < far_monomials; i += 5)
    for (int k = 0; k < 5; ++k) sum[k] += load4(b.far + 4 * (i + k)) * m[i + k];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + sum[4];
}

// The far field along a stretch of a ray: four polynomials of degree 4 in s = (t - middle) / half_length in [-1, 1].
struct FarOnRay {
  float middle, inverse_half;
  V4 c[5];            // coefficients of (f, Gx, Gy, Gz)
  float f_curvature;  // |f''| / 2 <= this, per unit t squared
  float g_curvature;  // |G''| / 2 <= this

  // The quartics through the values at s = -1, -1/2, 0, 1/2, 1: four of them in 16 lanes, the middle one apart.
  FarOnRay(const FieldLevel& block, const LocalRay& ray, float t0, float t1) {
    middle = 0.5F * (t0 + t1);
    const float half = max_of(0.5F * (t1 - t0), 1e-4F);
    inverse_half = 1 / half;
    const float x = ray.origin[0] + ray.direction[0] * middle, y = ray.origin[1] + ray.direction[1] * middle,
                z = ray.origin[2] + ray.direction[2] * middle;
    const V16 t = half * V16{-1, -1, -1, -1, -0.5F, -0.5F, -0.5F, -0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 1, 1, 1, 1};
    V16 m[far_monomials];
    fill_monomials<V16>(x + ray.direction[0] * t, y + ray.direction[1] * t, z + ray.direction[2] * t, m);
    V16 sum[5] = {};
    for (int i = 0; i < far_monomials; i += 5)
      for (int k = 0; k < 5; ++k) {
        const V4 c4 = load4(block.far + 4 * (i + k));
        sum[k] += __builtin_shufflevector(c4, c4, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3) * m[i + k];
      }
    const V16 total = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + sum[4];
    V4 v[4];
    __builtin_memcpy(v, &total, sizeof total);
    interpolate(v, far_at(block, x, y, z));
  }

  void add(float t, RaySums& s) const {
    const float a = (t - middle) * inverse_half;
    const V4 v = c[0] + a * (c[1] + a * (c[2] + a * (c[3] + a * c[4])));
    const V4 d = inverse_half * (c[1] + a * (2 * c[2] + a * (3 * c[3] + (4 * a) * c[4])));
    s.f += v[0];
    s.df += d[0];
    for (int i = 0; i < 3; ++i) {
      s.g[i] += v[i + 1];
      s.dg[i] += d[i + 1];
    }
  }

 private:
  void interpolate(const V4 (&v)[4], V4 center) {
    const V4 even1 = v[0] + v[3], even2 = v[1] + v[2], odd1 = v[3] - v[0], odd2 = v[2] - v[1];
    c[0] = center;
    c[1] = (4.0F / 3) * odd2 - (1.0F / 6) * odd1;
    c[2] = (8.0F / 3) * even2 - (1.0F / 6) * even1 - 5 * center;
    c[3] = (2.0F / 3) * odd1 - (4.0F / 3) * odd2;
    c[4] = (2.0F / 3) * even1 - (8.0F / 3) * even2 + 4 * center;
    const float scale = inverse_half * inverse_half * 1.0001F;
    float bend[4];
    for (int i = 0; i < 4; ++i) bend[i] = abs_of(c[2][i]) + 3 * abs_of(c[3][i]) + 6 * abs_of(c[4][i]);
    f_curvature = bend[0] * scale;
    g_curvature = (bend[1] + bend[2] + bend[3]) * scale;
  }
};
