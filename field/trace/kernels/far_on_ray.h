// The far field at a point and along a ray. Part of block_kernels_<set>.cpp.

// Place of x^a y^b z^c among the monomials, as in far_field.h.
constexpr int monomial_at(int a, int b, int c) {
  const int d = a + b + c, rest = d - a;
  return d * (d + 1) * (d + 2) / 6 + rest * (rest + 1) / 2 + rest - b;
}

// The far polynomials by Horner's rule, unrolled by the compiler: the sum over c of the coefficients of x^A y^B z^c
// with c <= Degree - A - B, ...
template <int Degree, int A, int B, int C, class Z>
inline auto nested_in_z(const FieldLevel& level, const Z& z) {
  const V4 here = load4(level.far + 4 * monomial_at(A, B, C));
  if constexpr (A + B + C == Degree) return here;
  else return nested_in_z<Degree, A, B, C + 1>(level, z) * z + here;
}

// ... then over b ...
template <int Degree, int A, int B, class Y, class Z>
inline auto nested_in_y(const FieldLevel& level, const Y& y, const Z& z) {
  const auto here = nested_in_z<Degree, A, B, 0>(level, z);
  if constexpr (A + B == Degree) return here;
  else return nested_in_y<Degree, A, B + 1>(level, y, z) * y + here;
}

// ... and over a.
template <int Degree, int A = 0, class X, class Y, class Z>
inline auto nested_polynomial(const FieldLevel& level, const X& x, const Y& y, const Z& z) {
  const auto here = nested_in_y<Degree, A, 0>(level, y, z);
  if constexpr (A == Degree) return here;
  else return nested_polynomial<Degree, A + 1>(level, x, y, z) * x + here;
}

template <class X, class Y, class Z>
inline auto far_polynomial(const FieldLevel& level, const X& x, const Y& y, const Z& z) {
  return level.far_degree == 2   ? nested_polynomial<2>(level, x, y, z)
         : level.far_degree == 4 ? nested_polynomial<4>(level, x, y, z)
                                 : nested_polynomial<6>(level, x, y, z);
}

// (f, Gx, Gy, Gz) of the far field at a point.
inline V4 far_at(const FieldLevel& level, float x, float y, float z) { return far_polynomial(level, x, y, z); }

// A value and its derivative along a ray.
struct FarSlope {
  V4 value, slope;
};

// A coordinate of a point on a ray and its derivative; Horner's rule for both.
struct OnRay {
  float at, slope;
};
inline FarSlope operator*(const V4& c, const OnRay& x) { return {c * x.at, c * x.slope}; }
inline FarSlope operator*(const FarSlope& p, const OnRay& x) {
  return {p.value * x.at, p.slope * x.at + p.value * x.slope};
}
inline FarSlope operator+(const FarSlope& p, const V4& c) { return {p.value + c, p.slope}; }
inline FarSlope operator+(const FarSlope& p, const FarSlope& c) { return {p.value + c.value, p.slope + c.slope}; }

// The far field along a ray.
struct FarOnRay {
  const FieldLevel& level;
  const LocalRay& ray;

  OnRay coordinate(int k, float t) const { return {ray.origin[k] + ray.direction[k] * t, ray.direction[k]}; }

  void add(float t, RaySums& s) const {
    const OnRay x = coordinate(0, t), y = coordinate(1, t), z = coordinate(2, t);
    const FarSlope far = far_polynomial(level, x, y, z);
    s.f += far.value[0];
    s.df += far.slope[0];
    for (int i = 0; i < 3; ++i) {
      s.g[i] += far.value[i + 1];
      s.dg[i] += far.slope[i + 1];
    }
  }
};
