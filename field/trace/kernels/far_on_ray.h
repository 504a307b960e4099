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

// A value and its derivative along a ray.
struct FarSlope {
  V4 value, slope;
};

// A coordinate of a point on a ray and its derivative; Horner's rule for both.
struct OnRay {
  float at, slope;
};
inline FarSlope operator*(const FarSlope& p, const OnRay& x) {
  return {p.value * x.at, p.slope * x.at + p.value * x.slope};
}
inline FarSlope operator+(const FarSlope& p, const FarSlope& c) { return {p.value + c.value, p.slope + c.slope}; }

// The far field along a ray.
struct FarOnRay {
  const FieldLevel& level;
  const LocalRay& ray;

  void add(float t, RaySums& s) const {
    const auto coordinate = [&](int k) { return OnRay{ray.origin[k] + ray.direction[k] * t, ray.direction[k]}; };
    const FarSlope far = nested_polynomial<FarSlope>(coordinate(0), coordinate(1), coordinate(2), [&](int i) {
      return FarSlope{load4(level.far + 4 * i), V4{}};
    });
    s.f += far.value[0];
    s.df += far.slope[0];
    for (int i = 0; i < 3; ++i) {
      s.g[i] += far.value[i + 1];
      s.dg[i] += far.slope[i + 1];
    }
  }
};
