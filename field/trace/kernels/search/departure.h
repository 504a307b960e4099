// Away from a surface by what is known of the field about the hit, without a sum over sources. Part of
// block_kernels_<set>.cpp.

// What is known about the hits that rays leave; nothing of rays that are not `known`.
template <class F>
struct AroundOf {
  MaskOf<F> known{};
  F place[3], f, gradient[3], g[3], h[6], nearest, second, third;
};

// The numbers of PointField that count, one after the other.
inline constexpr int around_numbers = 16;
static_assert(__builtin_offsetof(PointField, third) == (around_numbers - 1) * sizeof(float));

template <class F>
inline void set_numbers(const F (&from)[around_numbers], AroundOf<F>& to) {
  to.f = from[0];
  for (int k = 0; k < 3; ++k) to.gradient[k] = from[1 + k];
  for (int k = 0; k < 3; ++k) to.g[k] = from[4 + k];
  for (int k = 0; k < 6; ++k) to.h[k] = from[7 + k];
  to.nearest = from[13];
  to.second = from[14];
  to.third = from[15];
}

inline AroundOf<float> around_in(const BlockView& block, const FieldAround* around) {
  AroundOf<float> a{};
  if (around == nullptr || around->block != block.owner) return a;
  a.known = true;
  float numbers[around_numbers];
  __builtin_memcpy(numbers, &around->field, sizeof numbers);
  set_numbers(numbers, a);
  for (int k = 0; k < 3; ++k) a.place[k] = around->place[k];
  return a;
}

// How far rays that begin at t0 beside a hit are proved to be outside by taylor_remainder.h about the hit. The ray
// is s from it at t0, and at t0 + h no more than s + h: with h >= 16 s remainders in (s + h)^2 are at most (17/16)^2 of
// those in h^2, and s + h is at most 17/16 h. Where patches give the angle they do so on the ray itself. Returns the
// rays of which that much is proved; `front` is how far.
template <Angle Rule, class F>
inline MaskOf<F> depart(Marcher<Rule, F>& march, const RayOf<F>& ray, const AroundOf<F>& around, F t0, F end,
                        MaskOf<F> rays, F& front) {
  using Mask = MaskOf<F>;
  constexpr float least_steps = 16, remainder_growth = 1.13F, way_growth = 1.0625F;
  OnRay<F> at[3];
  F way[3], direction[3];
  for (int k = 0; k < 3; ++k) {
    at[k] = {ray.origin[k] + ray.direction[k] * t0, ray.direction[k]};
    way[k] = at[k].at - around.place[k];
    direction[k] = ray.direction[k];
  }
  const F s = root_of(dot3(way, way));
  const Mask close = rays & around.known & (s < 0.01F * around.nearest);
  // For alpha < 0 the field would have to be bounded from below, too.
  if (!any(close) || march.block.iso.two_sided) return Mask{};

  const float m = static_cast<float>(march.block.degree);
  RaySums<F> sums;
  sums.second = around.second;
  sums.third = around.third;
  const auto beside = march.bend_by(sums, s, s / around.nearest);
  sums.f = around.f + dot3(around.gradient, way) + beside.field;
  sums.df = dot3(around.gradient, direction);
  F moved[3];
  bend_of(around.h, way, moved);
  for (int k = 0; k < 3; ++k) sums.g[k] = around.g[k] + moved[k];
  bend_of(around.h, direction, sums.dg);
  // Remainders also grow by those of the far field; the series of the sums are at least m (m + 1) / 2 and, of G,
  // (m + 1) (m + 2) / 2.
  constexpr float more = remainder_growth - 1;
  sums.second = remainder_growth * around.second + 2 * more / (m * (m + 1)) * march.level.far_bend();
  sums.third = remainder_growth * around.third + 2 * more / ((m + 1) * (m + 2)) * march.level.far_g_bend();

  // Places are rounded twice.
  const auto p = march.told_by(t0, at, sums, around.nearest / way_growth, march.level.g_error() + beside.gradient, 2);
  const Mask outside = close & p.sure;
  if (!any(outside)) return outside;
  Search<Rule, F> start(march, t0, end);
  start.record(outside, p);
  const Mask away = outside & (start.front - t0 >= least_steps * s);
  assign(away, front, start.front);
  return away;
}
