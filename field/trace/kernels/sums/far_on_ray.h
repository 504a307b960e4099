// The far field at a point and along a ray. Part of block_kernels_<set>.cpp.

// Place of x^a y^b z^c among the monomials, as in far_field.h.
constexpr int monomial_at(int a, int b, int c) {
  const int d = a + b + c, rest = d - a;
  return d * (d + 1) * (d + 2) / 6 + rest * (rest + 1) / 2 + rest - b;
}

// The coefficients of one monomial: all four, for one place ...
struct AllFour {
  const float* far;
  V4 at(int monomial) const { return load4(far + 4 * monomial); }
};
// ... or one of them, for a place in each lane.
struct OneOfFour {
  const float* far;
  float at(int monomial) const { return far[4 * monomial]; }
};

// The far polynomials by Horner's rule, unrolled by the compiler: the sum over c of the coefficients of x^A y^B z^c
// with c <= Degree - A - B, ...
template <int Degree, int A, int B, int C, class Far, class Z>
inline auto nested_in_z(const Far& far, const Z& z) {
  const auto here = far.at(monomial_at(A, B, C));
  if constexpr (A + B + C == Degree) return here;
  else return nested_in_z<Degree, A, B, C + 1>(far, z) * z + here;
}

// ... then over b ...
template <int Degree, int A, int B, class Far, class Y, class Z>
inline auto nested_in_y(const Far& far, const Y& y, const Z& z) {
  const auto here = nested_in_z<Degree, A, B, 0>(far, z);
  if constexpr (A + B == Degree) return here;
  else return nested_in_y<Degree, A, B + 1>(far, y, z) * y + here;
}

// ... and over a.
template <int Degree, int A = 0, class Far, class X, class Y, class Z>
inline auto nested_polynomial(const Far& far, const X& x, const Y& y, const Z& z) {
  const auto here = nested_in_y<Degree, A, 0>(far, y, z);
  if constexpr (A == Degree) return here;
  else return nested_polynomial<Degree, A + 1>(far, x, y, z) * x + here;
}

// The degrees that levels have.
template <class Far, class X, class Y, class Z>
inline auto far_polynomial(const FieldLevel& level, const Far& far, const X& x, const Y& y, const Z& z) {
  if (level.far_degree == 2) return nested_polynomial<2>(far, x, y, z);
  return level.far_degree == 4 ? nested_polynomial<4>(far, x, y, z) : nested_polynomial<5>(far, x, y, z);
}

// (f, Gx, Gy, Gz) of the far field at a point.
inline V4 far_at(const FieldLevel& level, float x, float y, float z) {
  return far_polynomial(level, AllFour{level.far}, x, y, z);
}

// A value and its derivative along a ray. Value: V4, all four of one ray; PacketFloat, one of each ray of a packet.
template <class Value>
struct FarSlope {
  Value value, slope;
};

// A coordinate of a point on a ray and its derivative; Horner's rule for both.
template <class F>
struct OnRay {
  F at, slope;
};
inline Probe probe_of(const OnRay<float> (&p)[3]) {
  return {{Native{} + p[0].at, Native{} + p[1].at, Native{} + p[2].at},
          {Native{} + p[0].slope, Native{} + p[1].slope, Native{} + p[2].slope}};
}
template <class Coefficients, class F>
inline auto operator*(const Coefficients& c, const OnRay<F>& x) {
  using Value = decltype(c * x.at);
  return FarSlope<Value>{c * x.at, c * x.slope};
}
template <class Value, class F>
inline FarSlope<Value> operator*(const FarSlope<Value>& p, const OnRay<F>& x) {
  return {p.value * x.at, p.slope * x.at + p.value * x.slope};
}
template <class Value, class Coefficients>
inline FarSlope<Value> operator+(const FarSlope<Value>& p, const Coefficients& c) {
  return {p.value + c, p.slope};
}
template <class Value>
inline FarSlope<Value> operator+(const FarSlope<Value>& p, const FarSlope<Value>& c) {
  return {p.value + c.value, p.slope + c.slope};
}

// The far field at (x, y, z), with its derivatives, added to the sums.
inline void add_far(const FieldLevel& level, const OnRay<float> (&p)[3], RaySums<float>& s) {
  const FarSlope<V4> far = far_polynomial(level, AllFour{level.far}, p[0], p[1], p[2]);
  s.f += far.value[0];
  s.df += far.slope[0];
  for (int i = 0; i < 3; ++i) {
    s.g[i] += far.value[i + 1];
    s.dg[i] += far.slope[i + 1];
  }
}
