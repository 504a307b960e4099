// Where rays may leave from beside the surface, for one hit or for as many as there are lanes. Part of
// block_kernels_<set>.cpp.

inline float lanes_at(const float* from, float) { return *from; }
inline PacketFloat lanes_at(const float* from, PacketFloat) { return load_native(from); }
inline void store_lanes(float v, float* to) { *to = v; }
inline void store_lanes(PacketFloat v, float* to) { __builtin_memcpy(to, &v, sizeof v); }

// Whether each lane is one of the first `count`.
inline bool first_of(int count, float) { return count > 0; }
inline PacketMask first_of(int count, PacketFloat) {
  return PacketMask(count < packet_lanes ? (1U << count) - 1 : all_lane_bits);
}

// How far to go along the normal until the field is certainly below 1: f and |G| there are bounded by their Taylor
// polynomials and the remainders of taylor_remainder.h, with series sums up to twice their values at 0 (a step of at
// most a tenth of the distance). Twice the errors of the block, since a ray may start in its neighbour.
template <bool Varied, class F>
class SurfaceStart {
  using Mask = MaskOf<F>;

 public:
  SurfaceStart(const SurfaceRule& rule, const SurfaceLanes& hits, int first, int count)
      : rule_(rule), hits_(hits), first_(first), known_(first_of(count, F{})) {
    load3(hits.gradient, gradient_);
    load3(hits.si_gradient, g_);
    for (int i = 0; i < 6; ++i) h_[i] = from(hits.hessian[i]);
    f_ = from(hits.f);
    nearest_ = from(hits.nearest);
    const F n = all_lanes<F>(static_cast<float>(rule.degree));
    bend_ = from(hits.second) * n * (n + 1.0F);
    g_bend_ = from(hits.third) * (n + 1.0F) * (n + 2.0F);
    // Where no rule is certified, beside the point of a cone, the stated error may be infinite and no step would be
    // best.
    constexpr float most_error = 1e-3F;
    f_error_ = 2.0F * min_of(from(hits.f_error), most_error);
    g_error_ = 2.0F * min_of(from(hits.g_error), most_error);
    // As march.h: sums of floats, and positions in float.
    raise_ = 1.0F + 2.0F * (rounding + position_rounding * (n + 1.0F) / nearest_);
  }

  // The direction in which the corrected field grows; any length.
  void find_growth(F (&growth)[3]) const {
    const F y = root_of(dot3(g_, g_)), inverse = 1.0F / max_of(y, 1e-12F);
    F share_weight{};
    const auto [x_weight, y_weight] = weights(f_, y, share_weight);
    const F along[3] = {g_[0] * inverse, g_[1] * inverse, g_[2] * inverse};
    F bent[3];
    bend_of(h_, along, bent);
    // Beyond its range the angle does not change.
    if constexpr (Varied)
      share_weight = select((from(hits_.share) >= 0.0F) & (from(hits_.share) <= 1.0F), share_weight, F{});
    for (int k = 0; k < 3; ++k) {
      growth[k] = gradient_[k] * x_weight + bent[k] * y_weight;
      if constexpr (Varied) growth[k] += from(hits_.share_gradient[k]) * share_weight;
    }
  }

  struct Step {
    F length, margin;
  };
  // Where no step is proved, beside a touch of the surface with itself, the one that comes nearest to it; its margin is
  // not positive.
  Step find_step(const F (&normal)[3]) {
    // So that rays get away from where rounding leaves doubts, or, where alpha varies, what tables and shares are off
    // by: 7e-5 was met at a kink.
    constexpr float enough = Varied ? 1.5e-4F : 2e-5F;
    // Near a single skeleton a step of s distances lowers C by s (n - 1): shorter ones are not enough.
    constexpr float shortest = Varied ? 4 * shortest_start : shortest_start;
    bend_of(h_, normal, bent_);
    slope_ = dot3(gradient_, normal);
    if constexpr (Varied) share_slope_ = share_along(normal);
    F best{}, largest = all_lanes<F>(-infinity);
    Mask open = known_;
    for (float share = shortest; share < longest_start && any(open); share *= 2) {
      const F step = share * nearest_, found = margin(step);
      const Mask better = open & (found > largest);
      best = select(better, step, best);
      largest = select(better, found, largest);
      open = open & !(found > enough);
    }
    return {best, largest};
  }

  // Of the places themselves: what is summed there has no remainder.
  F margin_here() const { return margin(F{}); }

 private:
  F from(const float (&of)[lanes]) const { return lanes_at(of + first_, F{}); }
  void load3(const float (&of)[3][lanes], F (&to)[3]) const {
    for (int k = 0; k < 3; ++k) to[k] = from(of[k]);
  }

  struct Weights {
    F x, y;
  };
  // In which proportion C grows with f and |G|, and with the share: the residual V(u) - v falls where C grows.
  Weights weights(F x, F y, F& of_share) const {
    if constexpr (!Varied) {
      const F slope = CurvePlace<F>(rule_.iso, turned_u(rule_.iso, x, y)).within(rule_.iso.slope);
      return {rule_.iso.sin_theta + slope * rule_.iso.cos_theta, rule_.iso.cos_theta - slope * rule_.iso.sin_theta};
    } else {
      const AnglePlace<F> place(rule_.tables, from(hits_.share), x, y);
      const F slope = place.exact_slope(rule_.tables);
      of_share = -place.growth(rule_.tables);
      return {place.sine + slope * place.cosine, place.cosine - slope * place.sine};
    }
  }

  F share_along(const F (&normal)[3]) const {
    F gradient[3];
    load3(hits_.share_gradient, gradient);
    return dot3(gradient, normal);
  }

  // Of the field at a step along the normal; positive only where it is certainly below 1.
  F margin(F step) const {
    const F bend = bend_ * step * step, at = f_ + slope_ * step;
    F g[3];
    for (int k = 0; k < 3; ++k) g[k] = g_[k] + bent_[k] * step;
    const F y = (root_of(dot3(g, g)) + g_bend_ * step * step + g_error_) * raise_;
    const F x = (at + bend + f_error_) * raise_;
    const F right = margin(step, x, y);
    if (!rule_.iso.two_sided) return right;
    return min_of(right, margin(step, max_of((at - bend - f_error_) / raise_, 0.0F), y));
  }
  F margin(F step, F x, F y) const {
    if constexpr (Varied) return margin_of_shares(step, x, y);
    else return margin_at(rule_.iso, x, y);
  }

  // For all shares that alpha may have on the step: C is largest at one end of them, see angle_place.h.
  F margin_of_shares(F step, F x, F y) const {
    const Mask upward = right_of_reference(x, y, rule_.degree);
    const F left = 1.0F - from(hits_.share_growth) * step / nearest_, bend = from(hits_.share_bend) * step * step;
    const F move = share_slope_ * step, error = from(hits_.share_error);
    const F change =
        select(upward, max_of(move + bend, 0.0F) + error, min_of(move - bend, 0.0F) - error) / max_of(left, 0.1F);
    const Mask known = (left > 0.1F) & (bend < infinity);
    const F any_share = select(upward, all_lanes<F>(1), F{});
    return AnglePlace<F>(rule_.tables, select(known, from(hits_.share) + change, any_share), x, y).margin();
  }

  const SurfaceRule& rule_;
  const SurfaceLanes& hits_;
  const int first_;
  const Mask known_;
  F f_, gradient_[3], g_[3], h_[6], nearest_, bend_, g_bend_, f_error_, g_error_, raise_;
  F bent_[3]{}, slope_{}, share_slope_{};
};

template <bool Varied, class F>
inline void find_starts(const SurfaceRule& rule, int first, int count, SurfaceLanes& hits) {
  SurfaceStart<Varied, F> start(rule, hits, first, count);
  F growth[3], normal[3];
  start.find_growth(growth);
  const F largest = max_of(max_of(abs_of(growth[0]), abs_of(growth[1])), max_of(abs_of(growth[2]), 1e-30F));
  for (int k = 0; k < 3; ++k) {
    store_lanes(growth[k], hits.growth[k] + first);
    normal[k] = -growth[k] / largest;
  }
  const F length = root_of(dot3(normal, normal));
  for (F& n : normal) n /= length;
  const auto step = start.find_step(normal);
  store_lanes(step.length, hits.step + first);
  store_lanes(step.margin, hits.margin + first);
}

template <bool Varied>
inline void find_starts(const SurfaceRule& rule, int count, SurfaceLanes& hits) {
  constexpr int worth_a_register = 3;
  int first = 0;
  for (; count - first >= worth_a_register; first += packet_lanes)
    find_starts<Varied, PacketFloat>(rule, first, count - first, hits);
  for (; first < count; ++first) find_starts<Varied, float>(rule, first, 1, hits);
}

void surface_starts(const SurfaceRule& rule, int count, SurfaceLanes& hits) {
  if (rule.tables.count > 1) find_starts<true>(rule, count, hits);
  else find_starts<false>(rule, count, hits);
}

template <bool Varied>
inline void find_margins(const SurfaceRule& rule, int count, SurfaceLanes& places) {
  for (int first = 0; first < count; first += packet_lanes)
    store_lanes(SurfaceStart<Varied, PacketFloat>(rule, places, first, count - first).margin_here(),
                places.margin + first);
}

void place_margins(const SurfaceRule& rule, int count, SurfaceLanes& places) {
  if (rule.tables.count > 1) find_margins<true>(rule, count, places);
  else find_margins<false>(rule, count, places);
}
