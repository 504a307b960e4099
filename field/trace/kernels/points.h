// The field at a point, with all derivatives that its normal needs. Part of block_kernels_<set>.cpp.

// Derivatives of the far polynomials by rows of monomials: d/dx of x^a y^b z^c is a x^(a-1) y^b z^c, and so on.
inline void far_derivatives(const FieldLevel& level, const float p[3], V4 (&d)[3]) {
  float power[3][5];
  for (int axis = 0; axis < 3; ++axis) {
    power[axis][0] = 1;
    for (int k = 1; k < 5; ++k) power[axis][k] = power[axis][k - 1] * p[axis];
  }
  int i = 0;
  for (int degree = 0; degree <= 4; ++degree)
    for (int a = degree; a >= 0; --a)
      for (int b = degree - a; b >= 0; --b, ++i) {
        const int e[3] = {a, b, degree - a - b};
        const V4 c = load4(level.far + 4 * i);
        for (int axis = 0; axis < 3; ++axis) {
          if (e[axis] == 0) continue;
          float m = static_cast<float>(e[axis]);
          for (int k = 0; k < 3; ++k) m *= power[k][e[k] - (k == axis ? 1 : 0)];
          d[axis] += c * m;
        }
      }
}

// A / f of angle_field.h, as in march.h.
inline void find_mean_share(const FieldLevel& angle, int degree, const float p[3], PointField& out) {
  FullSums s{};
  V16 nearest{};
  for_each_list(angle, degree, FullSummer{p, nearest, s});
  V4 d[3] = {};
  far_derivatives(angle, p, d);
  const float inverse = 1 / max_of(out.f, 1e-20F), n = static_cast<float>(degree);
  out.share = (s.f + far_at(angle, p[0], p[1], p[2])[0]) * inverse;
  for (int i = 0; i < 3; ++i) out.share_gradient[i] = (s.df[i] + d[i][0] - out.share * out.gradient[i]) * inverse;
  out.share_bend = n * (n + 1) * (s.second + out.share * out.second) * inverse;
}

inline void find_strand_share(const FieldLevel& level, int degree, const float p[3], PointField& out) {
  constexpr float axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const ShareValue<3> value = strand_share(level, degree, p, axes);
  out.share = value.share;
  for (int i = 0; i < 3; ++i) out.share_gradient[i] = value.slope[i];
  out.share_bend = value.bend;
}

PointField point_field(const FieldLevel& level, int degree, const float p[3]) {
  FullSums s{};
  V16 nearest{};
  for_each_list(level, degree, FullSummer{p, nearest, s});
  const V4 far = far_at(level, p[0], p[1], p[2]);
  V4 d[3] = {};
  far_derivatives(level, p, d);
  PointField out;
  out.f = s.f + far[0];
  out.second = s.second;
  out.third = s.third;
  out.nearest = 1 / root_of(max_of(largest_lane(nearest), 1.0F / 64));  // as in march.h
  for (int i = 0; i < 3; ++i) {
    out.gradient[i] = s.df[i] + d[i][0];
    out.si_gradient[i] = s.g[i] + far[i + 1];
    out.hessian[i] = s.h[i] + d[i][i + 1];
  }
  out.hessian[3] = s.h[3] + d[0][2];
  out.hessian[4] = s.h[4] + d[0][3];
  out.hessian[5] = s.h[5] + d[1][3];
  out.share = out.share_bend = 0;
  for (float& g : out.share_gradient) g = 0;
  if (level.angle != nullptr) find_mean_share(*level.angle, degree, p, out);
  if (level.strands != nullptr) find_strand_share(level, degree, p, out);
  return out;
}
