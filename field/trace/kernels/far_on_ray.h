// The far field at a point and along a ray. Part of block_kernels_<set>.cpp.

// Place of x^a y^b z^c among the monomials, as in far_field.h.
constexpr int monomial_at(int a, int b, int c) {
  const int d = a + b + c, rest = d - a;
  return d * (d + 1) * (d + 2) / 6 + rest * (rest + 1) / 2 + rest - b;
}

// Horner's rule unrolled by the compiler: sum over c of the coefficients of x^A y^B z^c, c <= Degree - A - B, ...
template <int A, int B, int C, class V, class X, class Coefficient>
inline V nested_in_z(const X& z, const Coefficient& coefficient) {
  const V here = coefficient(monomial_at(A, B, C));
  if constexpr (A + B + C == 4) return here;
  else return nested_in_z<A, B, C + 1, V>(z, coefficient) * z + here;
}

// ... then over b ...
template <int A, int B, class V, class X, class Coefficient>
inline V nested_in_y(const X& y, const X& z, const Coefficient& coefficient) {
  const V here = nested_in_z<A, B, 0, V>(z, coefficient);
  if constexpr (A + B == 4) return here;
  else return nested_in_y<A, B + 1, V>(y, z, coefficient) * y + here;
}

// ... and over a: the polynomials of degree 4 at x, y, z; `coefficient(i)` gives that of monomial i for all lanes of V.
template <class V, int A = 0, class X, class Coefficient>
inline V nested_polynomial(const X& x, const X& y, const X& z, const Coefficient& coefficient) {
  const V here = nested_in_y<A, 0, V>(y, z, coefficient);
  if constexpr (A == 4) return here;
  else return nested_polynomial<V, A + 1>(x, y, z, coefficient) * x + here;
}

// (f, Gx, Gy, Gz) of the far field at a point.
inline V4 far_at(const FieldLevel& level, float x, float y, float z) {
  return nested_polynomial<V4>(x, y, z, [&](int i) { return load4(level.far + 4 * i); });
}

// The same at four points; each coordinate stands in four lanes for each point. Not inlined: with the middle point
// beside it, it would not fit into the registers.
[[gnu::noinline]] V16 far_at_four(const FieldLevel& level, V16 x, V16 y, V16 z) {
  return nested_polynomial<V16>(x, y, z, [&](int i) {
    const V4 c = load4(level.far + 4 * i);
    return __builtin_shufflevector(c, c, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
  });
}

// The far field along a stretch of a ray: four polynomials of degree 4 in s = (t - middle) / half_length in [-1, 1].
struct FarOnRay {
  float middle, inverse_half;
  V4 c[5];            // coefficients of (f, Gx, Gy, Gz)
  float f_curvature;  // |f''| / 2 <= this, per unit t squared
  float g_curvature;  // |G''| / 2 <= this

  // The quartics through the values at s = -1, -1/2, 0, 1/2, 1: four of them in 16 lanes, the middle one apart.
  // Their derivatives have the rounding of the values over half the length, so that it must not be too short.
  FarOnRay(const FieldLevel& block, const LocalRay& ray, float t0, float t1, float least_half = 1e-4F) {
    middle = 0.5F * (t0 + t1);
    const float half = max_of(0.5F * (t1 - t0), least_half);
    inverse_half = 1 / half;
    const float x = ray.origin[0] + ray.direction[0] * middle, y = ray.origin[1] + ray.direction[1] * middle,
                z = ray.origin[2] + ray.direction[2] * middle;
    const V16 t = half * V16{-1, -1, -1, -1, -0.5F, -0.5F, -0.5F, -0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 1, 1, 1, 1};
    const V16 total = far_at_four(block, x + ray.direction[0] * t, y + ray.direction[1] * t, z + ray.direction[2] * t);
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
