// The field at a point, with all derivatives that its normal needs. Part of block_kernels_<set>.cpp.

// A far polynomial (f, Gx, Gy, Gz) with its derivatives by the first `Known` of z, y and x, the order in which Horner's
// rule takes them; it does not depend on the others yet.
template <int Known>
struct FarSlopes {
  V4 value, slope[Known];
};

// The coordinate that becomes the `Known`-th known one.
template <int Known>
struct Coordinate {
  float at;
};

template <int Known>
inline FarSlopes<Known> operator*(const V4& c, const Coordinate<Known>& x) {
  FarSlopes<Known> r{.value = c * x.at, .slope = {}};
  r.slope[Known - 1] = c;
  return r;
}
template <int Before, int Known>
inline FarSlopes<Known> operator*(const FarSlopes<Before>& p, const Coordinate<Known>& x) {
  FarSlopes<Known> r{.value = p.value * x.at, .slope = {}};
  for (int i = 0; i < Before; ++i) r.slope[i] = p.slope[i] * x.at;
  r.slope[Known - 1] = Before == Known ? r.slope[Known - 1] + p.value : p.value;
  return r;
}
template <int Known>
inline FarSlopes<Known> operator+(FarSlopes<Known> p, const V4& c) {
  p.value += c;
  return p;
}
template <int Known, int Fewer>
inline FarSlopes<Known> operator+(FarSlopes<Known> p, const FarSlopes<Fewer>& c) {
  p.value += c.value;
  for (int i = 0; i < Fewer; ++i) p.slope[i] += c.slope[i];
  return p;
}

inline FarSlopes<3> far_slopes(const FieldLevel& level, const float p[3]) {
  const Coordinate<3> x{p[0]};
  const Coordinate<2> y{p[1]};
  const Coordinate<1> z{p[2]};
  return far_polynomial(level, AllFour{level.far}, x, y, z);
}

// A / f of angle_field.h, as in march.h.
inline void find_mean_share(const FieldLevel& angle, int degree, const float p[3], PointField& out) {
  FullSums s{};
  V16 nearest{};
  for_each_list(angle, degree, FullSummer{p, nearest, s});
  const FarSlopes far = far_slopes(angle, p);
  const float inverse = 1 / max_of(out.f, 1e-20F), n = static_cast<float>(degree);
  out.share = (s.f + far.value[0]) * inverse;
  for (int i = 0; i < 3; ++i)
    out.share_gradient[i] = (s.df[i] + far.slope[2 - i][0] - out.share * out.gradient[i]) * inverse;
  out.share_bend = n * (n + 1) * (s.second + out.share * out.second) * inverse;
}

PointField point_field(const FieldLevel& level, int degree, const float p[3]) {
  FullSums s{};
  V16 nearest{};
  for_each_list(level, degree, FullSummer{p, nearest, s});
  const FarSlopes far = far_slopes(level, p);
  const V4 d[3] = {far.slope[2], far.slope[1], far.slope[0]};  // by x, y, z
  PointField out;
  out.f = s.f + far.value[0];
  out.second = s.second;
  out.third = s.third;
  out.nearest = 1 / root_of(max_of(largest_lane(nearest), 1.0F / 64));  // as in march.h
  for (int i = 0; i < 3; ++i) {
    out.gradient[i] = s.df[i] + d[i][0];
    out.si_gradient[i] = s.g[i] + far.value[i + 1];
    out.hessian[i] = s.h[i] + d[i][i + 1];
  }
  out.hessian[3] = s.h[3] + d[0][2];
  out.hessian[4] = s.h[4] + d[0][3];
  out.hessian[5] = s.h[5] + d[1][3];
  out.share = out.share_bend = 0;
  for (float& g : out.share_gradient) g = 0;
  if (level.angle != nullptr) find_mean_share(*level.angle, degree, p, out);
  return out;
}
