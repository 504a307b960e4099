// Certified steps along a ray with the field of one level of a block: what a sample proves of the stretches beside it.
// Part of block_kernels_<set>.cpp.

template <Angle Rule, class F = float>
struct Marcher : Sampler<Rule, F> {
  using Place = Sampler<Rule, F>;
  using Place::angle;
  using Place::block;
  using Place::exits;
  using Place::level;
  using Place::Place;
  using typename Place::Mask;
  using typename Place::Sample;

  // Positive where the field with these sums is below 1 on [t, t + h]: surely, or, around a sample that is not sure, as
  // summed.
  F margin(const Sample& p, F x, F y, F h, Mask asked) const {
    if constexpr (Rule != Angle::One) return angle().margin_within(p, x, y, h, asked);
    F found = margin_at(block.iso, x * p.raise, y * p.raise);
    const Mask as_summed = asked & !p.sure;
    if (any(as_summed)) found = select(as_summed, nominal_margin_at(block.iso, x, y), found);
    return found;
  }

  // The same to within rounding.
  F nominal_margin(const Sample& p, F x, F y, F h) const {
    if constexpr (Rule != Angle::One) return angle().nominal_within(p, x, y, h);
    return nominal_margin_at(block.iso, x, y);
  }

  // sum_{j=1..m} (m+1-j) a^j for m = degree (field) and degree + 1 (gradient): psi_1^m(q) / q^2 with a = 1/(1-q),
  // a form of the remainder without cancellation. The second sum is the first plus a + .. + a^(m+1).
  struct Series {
    F field, gradient;
  };
  Series series_of(F a) const {
    if (block.degree == 4) {
      const F a2 = a * a, pair = a + a2, field = (4 * a + 3 * a2) + (a + pair) * a2;
      return {field, field + (pair + (pair + a2 * a) * a2)};
    }
    F field{}, powers = all_lanes<F>(1);
    for (int j = 1; j <= block.degree; ++j) {
      field = (field + static_cast<float>(j)) * a;
      powers = 1 + powers * a;
    }
    return {field, field + powers * a};
  }

  // Whether all of [t, t + h] is on the side of p, of the rays that are asked for.
  Mask stays_until(const Sample& p, F h, Mask asked) const {
    if constexpr (sizeof(F) == sizeof(float)) {
      if (exits) return inside_until(p, h);
    }
    return outside_until(p, h, asked);
  }

  // Whether t + h is on the other side than p.
  Mask crossed_at(const Sample& p, F h) const {
    if constexpr (sizeof(F) == sizeof(float)) {
      if (exits) return outside_at(p, h);
    }
    return inside_at(p, h);
  }

  // |G| at t + h to first order.
  static F turned_length(const Sample& p, F h) {
    F length2{};
    for (int i = 0; i < 3; ++i) {
      const F end = p.s.g[i] + p.s.dg[i] * h;
      length2 += end * end;
    }
    return root_of(length2);
  }

  // What the remainders of taylor_remainder.h add to f and |G| at t + h at most, |h| = q distances.
  struct Bend {
    F field, gradient;
  };
  Bend bend_until(const Sample& p, F h, F q) const { return bend_by(p.s, h, q); }
  Bend bend_by(const RaySums<F>& sums, F h, F q) const {
    const Series series = series_of(1 / (1 - q));
    const F hh = h * h;
    return {(sums.second * series.field + level.far_bend()) * hh,
            (sums.third * series.gradient + level.far_g_bend()) * hh};
  }

  // Whether the field is below 1 on all of [t, t + h] (h of either sign). Both bounds, with their remainders, are
  // convex in h, so the ends suffice.
  Mask outside_until(const Sample& p, F h, Mask asked) const {
    const F q = abs_of(h) / p.distance;
    const Mask near = asked & (q < 0.9F);
    if (!any(near)) return near;
    const Bend bend = bend_until(p, h, q);
    const F x_end = p.s.f + p.s.df * h + bend.field;
    const F y_up = max_of(p.y, turned_length(p, h) + bend.gradient + level.g_error());
    const Mask below = near & (margin(p, max_of(p.s.f, x_end), y_up, h, near) > 0.0F);
    if (!block.iso.two_sided || !any(below)) return below;
    const F x_low = min_of(p.s.f, p.s.f + p.s.df * h - bend.field) * (1 - rounding) - 2.0F * level.f_error();
    return below & (margin(p, max_of(0.0F, x_low), y_up, h, below) > 0.0F);
  }

  // Whether the field is above 1 at t + h, by the same bounds and errors from below. For alpha < 0 the curve rises,
  // then falls in f: over an interval of f it is highest at its peak or at the end nearer to it.
  Mask inside_at(const Sample& p, F h) const {
    const F q = abs_of(h) / p.distance;
    const Bend bend = bend_until(p, h, q);
    const F x_high = p.s.f + p.s.df * h + bend.field;
    const F y = turned_length(p, h) - bend.gradient - level.g_error();
    F x = x_high - 2 * bend.field - 2.0F * level.f_error();
    const Mask known = (q < 0.5F) & (x > 0.0F) & (y > 0.0F);
    if (!any(known)) return known;
    if constexpr (Rule != Angle::One) return known & angle().inside_within(p, x, x_high, y, h);
    if (block.iso.two_sided) x = max_of(x, min_of(x_high, block.iso.peak_x));
    return known & (curve_at(block.iso, turned_u(block.iso, x, y)).value < turned_v(block.iso, x, y));
  }

  // The bounds of outside_until() from the other side; |G| at least its part along G at t. The lower bounds are concave
  // in h, so the ends suffice.
  bool inside_until(const Sample& p, float h) const {
    const float q = abs_of(h) / p.distance;
    if (!(q < 0.9F)) return false;
    const Bend bend = bend_until(p, h, q);
    float along = 0;
    for (int i = 0; i < 3; ++i) along += p.s.g[i] * (p.s.g[i] + p.s.dg[i] * h);
    const float y_end = along / max_of(p.y, 1e-12F) - bend.gradient;
    const float y = max_of(0, min_of(p.y, y_end)), x_end = p.s.f + p.s.df * h;
    const float x_high = max_of(p.s.f, x_end + bend.field);
    float x = max_of(0, min_of(p.s.f, x_end - bend.field));
    if constexpr (Rule != Angle::One) return angle().inside_within(p, x, x_high, y, h);
    if (block.iso.two_sided) x = max_of(x, min_of(x_high, block.iso.peak_x));
    return nominally_inside(block.iso, x, y);
  }

  bool outside_at(const Sample& p, float h) const {
    const float q = abs_of(h) / p.distance;
    if (!(q < 0.5F)) return false;
    const Bend bend = bend_until(p, h, q);
    const float y = turned_length(p, h) + bend.gradient, x = p.s.f + p.s.df * h;
    return nominal_margin(p, x + bend.field, y, h) > 0 &&
           (!block.iso.two_sided || nominal_margin(p, max_of(0, x - bend.field), y, h) > 0);
  }

  // Deep inside no gradient can bring the field below 1, and f falls at most as if all of it came from the nearest
  // source: f(t + h) >= f(t) (1 + |h| / d)^-n. Sums overflow where d^-n does, even when the share of the source is as
  // small as that of a segment of a few roundings: it is taken to be 1e-26. On a source itself the ray goes on by what
  // places in float are off, which no surface is nearer than.
  float deep_step(const Sample& p) const {
    constexpr float largest = 1e30F, if_overflown = 1e12F, least_step = 1e-6F;
    const bool is_known = p.s.f < infinity;
    const float f = is_known ? min_of(p.s.f, largest) : if_overflown;
    if (!(f > block.iso.critical)) return 0;
    const float step = 0.98F * p.distance * (inverse_root(block.iso.critical / f, block.degree) - 1);
    return is_known && f < largest ? max_of(step, 0) : max_of(step, least_step);
  }

  // The largest certified step from p in direction `sign`, at most `limit`; 0 when none was found.
  F certified_step(const Sample& p, float sign, F limit, Mask active) const {
    if constexpr (sizeof(F) == sizeof(float)) {
      if (exits) {
        const float deep = deep_step(p);
        return deep >= limit ? limit : max_of(deep, smooth_step(p, sign, limit, active));
      }
    }
    return smooth_step(p, sign, limit, active);
  }

  // How far the margin stays positive to second order, margin - b h - c h^2.
  static F step_to_zero(F margin, F b, F c) {
    return 2 * margin / (b + root_of(max_of(0.0F, b * b + 4 * max_of(c, 0.0F) * margin)) + 1e-20F);
  }

  F smooth_step(const Sample& p, float sign, F limit, Mask active) const {
    const F most = min_of(limit, 0.85F * p.distance);
    const float m = static_cast<float>(block.degree);
    const F c = p.x_weight * (p.s.second * m * (m + 1) * 0.5F + level.far_bend()) +
                p.y_weight * (p.s.third * (m + 1) * (m + 2) * 0.5F + level.far_g_bend());
    const F b = -sign * p.slope;
    F model = step_to_zero(p.margin, b, c);
    if constexpr (Rule == Angle::Patched) model = step_to_zero(p.margin, b, c + p.residual_bend);
    if constexpr (Rule == Angle::Mean) {
      if (p.residual_bend > 0.0F) {  // or with the worst share
        const float left = p.margin - p.residual_drop;
        model = step_to_zero(p.margin, b, c + p.residual_bend);
        if (left > 0.0F) model = max_of(model, step_to_zero(left, b, c));
      }
    }
    // Short steps end where the model does; long ones before, because their remainder grows faster than the model. A
    // packet tries in each round what comes next for each of its rays.
    constexpr int most_halvings = 5;
    const F end = min_of(0.985F * model, 0.7F * most);
    Mask whole = model > 0.8F * most, to_end = (end > 0.0F) & (end < 0.01F * p.distance);
    F before_end = end * 0.86F, step{};
    IntOf<F> halvings{};
    for (Mask open = active & (limit > 0.0F);;) {
      const F h = select(whole, most, select(to_end, end, before_end));
      open = open & (whole | (h > 0.0F));
      if (!any(open)) break;
      const Mask proved = open & stays_until(p, sign * h, open), halved = !(whole | to_end);
      step = select(proved, h, step);
      before_end = select(halved, 0.5F * before_end, before_end);
      count(halved, halvings);
      open = open & !proved & (halvings < most_halvings);
      to_end = to_end & whole;
      whole = Mask{};
    }
    return step;
  }
};
