// How far the share of angles moves along a ray. Part of block_kernels_<set>.cpp.

// Let 1 be the strongest strand that is listed. The share is a mean of gamma_ij over pairs; their weights f_i f_j may
// be divided by f_1. Those of the pairs of 1 then are f_j, which change slowly: mostly the others are farther away. All
// other pairs are light.
//
// There is at least one strand.
template <int Slopes>
struct ShareBounds {
  const StrandLanes<Slopes>& strands;
  const StrandLevel& level;
  int one;
  float n, f1, b1, a1, turned1, rho1;  // of the strongest: the field, 1 / d^2, n / d, sqrt(1 - c^2) / c, a turned
  float far, others;                   // the field of strands that are not listed, and of all but the strongest

  ShareBounds(const StrandLanes<Slopes>& s, const StrandLevel& l, int degree)
      : strands(s), level(l), one(strongest(s)), n(static_cast<float>(degree)) {
    f1 = s.sum[0][one];
    b1 = s.inverse2[one];
    a1 = n * root_of(b1);
    turned1 = s.turned[one];
    rho1 = a1 * turned1;
    far = max_of(0, s.before.value - s.field - s.points);
    V16 totals[12] = {};
    for (int b = 0; b < s.count; b += lanes) totals[0] += weaker(b);
    float t[16];
    sum_lanes(totals, t);
    others = t[0] + far + s.points;
  }

  static int strongest(const StrandLanes<Slopes>& s) {
    int best = 0;
    for (int i = 1; i < s.count; ++i)
      if (s.sum[0][i] > s.sum[0][best]) best = i;
    return best;
  }

  // Fields of 16 strands, without the strongest.
  V16 weaker(int b) const {
    constexpr Index16 lane{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return lane + b == one ? V16{} : load(strands.sum[0] + b);
  }
  // |u_j . u_1|
  V16 cosine(int b) const {
    V16 g{};
    for (int k = 1; k < 4; ++k) g += load(strands.sum[k] + b) * strands.sum[k][one];
    return larger(g, -g);
  }

  // With Phi and Delta the sums over pairs of f_i f_j (gamma_ij - share) and f_i f_j, divided by f_1, share(t + h) is
  // share + Phi / Delta, and Phi = 0 at the sample. A direction that turns by rho changes its turning by
  // 3.25 rho a + 3 rho^2 at most, so that with a = n / d
  //   |(f_j gamma_1j)''| <= f_j (n (n + 1) b_j + g^6 (16 a_j rho_1 + 42 a_j rho_j + 26 a_1 rho_1 + 144 (rho_1^2 +
  //   rho_j^2)))
  // and, for w_i = (n (4 n + 1) + 8 n^2) b_i + 160 rho_i^2 + 42 a_i rho_i and w_1 = (n (4 n + 1) + 16 n^2) b_1,
  //   |(f_i f_j gamma_ij / f_1)''| <= f_i f_j / f_1 (w_i + w_j + w_1).
  // g <= |u_1 . u_j| + 0.1 n (turned_1 + turned_j) as far as the bound is used. Phi'' grows by (1 - q)^-(3 n + 2) at
  // most, Delta falls by (1 - q)^(3 n).
  float bend() const {
    if (!(f1 > 0 && others > 0)) return infinity;
    const float wb = n * (4 * n + 1) + 8 * n * n, w1 = (n * (4 * n + 1) + 16 * n * n) * b1;
    const float turning = 26 * a1 * rho1 + 144 * rho1 * rho1;
    V16 totals[12] = {};
    for (int b = 0; b < strands.count; b += lanes) {
      const V16 f = weaker(b), near = load(strands.inverse2 + b), a = n * root_of(near),
                turned = load(strands.turned + b), rho = a * turned;
      const V16 moved = cosine(b) + 0.1F * n * (turned + turned1), g = moved < 1.0F ? moved : splat(1), g2 = g * g;
      const V16 turns = 16 * rho1 * a + 42.0F * a * rho + 144.0F * rho * rho + turning;
      totals[0] += f * (n * (n + 1) * near + g2 * g2 * g2 * turns);
      totals[1] += f * larger(others - f, splat(1e-6F * others)) * (wb * near + 160.0F * rho * rho + 42.0F * a * rho);
    }
    float t[16];
    sum_lanes(totals, t);
    const float* m = level.far_bend;
    const float far_pairs = n * (n + 1) * m[0] + 16 * rho1 * n * root_of(m[0]) + 42 * m[2] + 144 * m[1] + turning;
    const float direct = t[0] + far * far_pairs + n * (n + 1) * strands.point_bend;
    const float between =
        t[1] + others * (far * (wb * m[0] + 160 * m[1] + 42 * m[2]) + wb * strands.point_bend + 0.5F * others * w1);
    return 0.5F * (direct + between / f1) / others;
  }
};

// The share of the range of angles, with bounds along the directions: |share(t + h) - share - slope h| <=
// bend h^2 / (1 - q)^(6 n + 2), q = h / d < 0.1, d the distance to the nearest source.
template <int Slopes>
struct ShareValue {
  float share = 1, slope[Slopes] = {}, bend = infinity;
};

// At p, with derivatives along some directions.
template <int Slopes>
[[gnu::noinline]] ShareValue<Slopes> strand_share(const FieldLevel& level, int degree, const float p[3],
                                                  const float (&directions)[Slopes][3]) {
  StrandsAt<Slopes> at(level, degree, p, directions);
  at.near.add_angles(*level.strands, at.far);
  const Along<Slopes> above = at.near.numerator + at.near.numerator + at.sum_of_far(1),
                      below = at.near.denominator + at.near.denominator + at.sum_of_far(2);
  ShareValue<Slopes> out;
  if (!(below.value > 1e-36F)) return out;
  const float inverse = 1 / below.value;
  out.share = min_of(1, max_of(0, above.value * inverse));
  for (int i = 0; i < Slopes; ++i) out.slope[i] = (above.slope[i] - out.share * below.slope[i]) * inverse;
  if (at.near.count > 0) out.bend = ShareBounds<Slopes>(at.near, *level.strands, degree).bend();
  return out;
}
