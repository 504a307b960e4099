// Certified steps along a ray with the field of one level of a block. Part of block_kernels_<set>.cpp.

// `Varied`: the angle is that of the place.
template <bool Varied>
struct Marcher {
  using Sample = SampleOf<Varied>;

  const BlockView& block;
  const FieldLevel& level;
  const LocalRay& ray;
  FarOnRay far;
  bool exits = false;  // the ray is inside, and what is looked for is where it leaves: all samples are mirrored
  int evaluations = 0;
  mutable SampleShare<Varied> last;  // what of the angle was summed last

  Marcher(const BlockView& b, const FieldLevel& l, const LocalRay& r) : block(b), level(l), ray(r), far{l, r} {}

  Sample sample(float t) {
    ++evaluations;
    Sample p;
    p.t = t;
    p.s = {};
    const Probe probe{splat(ray.origin[0] + ray.direction[0] * t),
                      splat(ray.origin[1] + ray.direction[1] * t),
                      splat(ray.origin[2] + ray.direction[2] * t),
                      splat(ray.direction[0]),
                      splat(ray.direction[1]),
                      splat(ray.direction[2])};
    V16 nearest{};
    for_each_list(level, block.degree, RaySummer{probe, nearest, p.s});
    far.add(t, p.s);
    // At most eight half sides of the block: its scale, where it lists no sources at all.
    p.distance = 0.99999F / root_of(max_of(largest_lane(nearest), 1.0F / 64));
    const float yy = p.s.g[0] * p.s.g[0] + p.s.g[1] * p.s.g[1] + p.s.g[2] * p.s.g[2], y = root_of(yy);
    const float dy = (p.s.g[0] * p.s.dg[0] + p.s.g[1] * p.s.dg[1] + p.s.g[2] * p.s.dg[2]) / max_of(y, 1e-12F);
    p.raise = 1 + rounding + position_rounding * static_cast<float>(block.degree + 1) / p.distance;
    p.y = y + level.g_error;
    if constexpr (Varied) angle().judge(p, probe, y, dy);
    else judge(p, y, dy);
    if (!(p.residual == p.residual)) p.residual = p.nominal = -1;  // on a source: infinite field
    p.nominal = min_of(p.nominal, beyond_critical(p));
    p.sure = p.residual > 0;
    p.margin = p.sure ? p.residual : p.nominal;
    if (exits) mirror(p);
    return p;
  }

  // From the critical field on all is inside, whatever G is; there the table may have ended, or u and v may be so large
  // that floats do not tell which side of the curve they are on. What the curve has to tell is never above this, since
  // v grows at least as fast as f.
  float beyond_critical(const Sample& p) const {
    const float beyond = block.iso.critical - (p.s.f - level.f_error);
    return beyond < 0 ? beyond : infinity;
  }

  void judge(Sample& p, float y, float dy) const {
    const IsoCurve::View& iso = block.iso;
    const CurveValue curve = curve_at(iso, turned_u(iso, p.s.f, y));
    const float v = turned_v(iso, p.s.f, y);
    p.nominal = curve.value - v;
    p.x_weight = iso.sin_theta + curve.slope * iso.cos_theta;
    p.y_weight = iso.cos_theta - curve.slope * iso.sin_theta;
    p.slope = -p.x_weight * p.s.df - p.y_weight * dy;
    p.v = v;
    p.v_slope = turned_v(iso, p.s.df, dy);
    p.curve = curve.value;
    p.s.f += level.f_error;
    p.residual = margin_at(iso, p.s.f * p.raise, p.y * p.raise);
  }

  VariedAngle angle() const { return {block, level, ray, last.summed}; }

  // What is inside takes the part of what is outside. To within rounding: nothing more is claimed of exits.
  static void mirror(Sample& p) {
    p.margin = p.residual = p.nominal = -p.nominal;
    p.slope = -p.slope;
    p.sure = true;
  }

  // Positive where the field with these sums is below 1: surely, or, around a sample that is not sure, as summed.
  float margin(const Sample& p, float x, float y) const {
    return p.sure ? margin_at(block.iso, x * p.raise, y * p.raise) : nominal_margin_at(block.iso, x, y);
  }

  // (v / V)^(-1/(n-1)) - 1 of the field as summed, and its derivative: 0 on the surface and, near a single skeleton,
  // linear in the distance from it, so that Newton's method on it jumps well [Aydinlilar and Zanni 2021].
  struct Scaled {
    float value, slope;
    float newton_step() const { return -value / slope; }
  };
  Scaled scaled(const Sample& p) const {
    const float inverse = 1 / max_of(p.curve, 1e-6F), q = max_of(p.v * inverse, 1e-6F);
    const float side = exits ? -1.0F : 1.0F;                                    // of mirrored samples
    const float dq = (p.v_slope - q * (side * p.slope + p.v_slope)) * inverse;  // (v / V)' with V' = residual' + v'
    const float root = inverse_root(q, block.degree - 1);
    return {side * (root - 1), -side * root * dq / (q * static_cast<float>(block.degree - 1))};
  }

  // sum_{j=1..m} (m+1-j) a^j for m = degree (field) and degree + 1 (gradient): psi_1^m(q) / q^2 with a = 1/(1-q),
  // a form of the remainder without cancellation. The second sum is the first plus a + .. + a^(m+1).
  struct Series {
    float field, gradient;
  };
  Series series_of(float a) const {
    if (block.degree == 4) {
      const float a2 = a * a, pair = a + a2, field = (4 * a + 3 * a2) + (a + pair) * a2;
      return {field, field + (pair + (pair + a2 * a) * a2)};
    }
    float field = 0, powers = 1;
    for (int j = 1; j <= block.degree; ++j) {
      field = (field + static_cast<float>(j)) * a;
      powers = 1 + powers * a;
    }
    return {field, field + powers * a};
  }

  // Whether all of [t, t + h] is on the side of p.
  bool stays_until(const Sample& p, float h) const { return exits ? inside_until(p, h) : outside_until(p, h); }

  // Whether t + h is on the other side than p.
  bool crossed_at(const Sample& p, float h) const { return exits ? outside_at(p, h) : inside_at(p, h); }

  // Whether the field is below 1 on all of [t, t + h] (h of either sign): B3 and B4 of tracing.md. Both bounds are
  // convex in h, so the ends suffice.
  bool outside_until(const Sample& p, float h) const {
    const float q = abs_of(h) / p.distance;
    if (!(q < 0.9F)) return false;
    const Series series = series_of(1 / (1 - q));
    const float hh = h * h, bend = (p.s.second * series.field + level.far_bend) * hh;
    const float x_end = p.s.f + p.s.df * h + bend;
    float length2 = 0;
    for (int i = 0; i < 3; ++i) {
      const float end = p.s.g[i] + p.s.dg[i] * h;
      length2 += end * end;
    }
    const float y_end = root_of(length2) + (p.s.third * series.gradient + level.far_g_bend) * hh + level.g_error;
    const float y_up = max_of(p.y, y_end);
    if constexpr (Varied) return angle().margin_within(p, max_of(p.s.f, x_end), y_up, h) > 0;
    if (!(margin(p, max_of(p.s.f, x_end), y_up) > 0)) return false;
    if (!block.iso.two_sided) return true;
    const float x_low = min_of(p.s.f, p.s.f + p.s.df * h - bend) * (1 - rounding) - 2 * level.f_error;
    return margin(p, max_of(0, x_low), y_up) > 0;
  }

  // Whether the field is above 1 at t + h, by the same bounds and errors from below. For alpha < 0 the curve rises,
  // then falls in f: over an interval of f it is highest at its peak or at the end nearer to it.
  bool inside_at(const Sample& p, float h) const {
    const float q = abs_of(h) / p.distance;
    if (!(q < 0.5F)) return false;
    const Series series = series_of(1 / (1 - q));
    const float hh = h * h;
    float length2 = 0;
    for (int i = 0; i < 3; ++i) {
      const float end = p.s.g[i] + p.s.dg[i] * h;
      length2 += end * end;
    }
    const float bend = (p.s.second * series.field + level.far_bend) * hh, x_high = p.s.f + p.s.df * h + bend;
    const float y = root_of(length2) - (p.s.third * series.gradient + level.far_g_bend) * hh - level.g_error;
    float x = x_high - 2 * bend - 2 * level.f_error;
    if (!(x > 0) || !(y > 0)) return false;
    if constexpr (Varied) return angle().inside_within(p, x, y, h);
    if (block.iso.two_sided) x = max_of(x, min_of(x_high, block.iso.peak_x));
    return curve_at(block.iso, turned_u(block.iso, x, y)).value < turned_v(block.iso, x, y);
  }

  // The bounds of outside_until() from the other side; |G| at least its part along G at t. The lower bounds are concave
  // in h, so the ends suffice.
  bool inside_until(const Sample& p, float h) const {
    const float q = abs_of(h) / p.distance;
    if (!(q < 0.9F)) return false;
    const Series series = series_of(1 / (1 - q));
    const float hh = h * h, bend = (p.s.second * series.field + level.far_bend) * hh;
    float along = 0;
    for (int i = 0; i < 3; ++i) along += p.s.g[i] * (p.s.g[i] + p.s.dg[i] * h);
    const float y_end = along / max_of(p.y, 1e-12F) - (p.s.third * series.gradient + level.far_g_bend) * hh;
    const float y = max_of(0, min_of(p.y, y_end)), x_end = p.s.f + p.s.df * h;
    float x = max_of(0, min_of(p.s.f, x_end - bend));
    if constexpr (Varied) return angle().inside_within(p, x, y, h);
    if (block.iso.two_sided) x = max_of(x, min_of(max_of(p.s.f, x_end + bend), block.iso.peak_x));
    return nominally_inside(block.iso, x, y);
  }

  bool outside_at(const Sample& p, float h) const {
    const float q = abs_of(h) / p.distance;
    if (!(q < 0.5F)) return false;
    const Series series = series_of(1 / (1 - q));
    const float hh = h * h, bend = (p.s.second * series.field + level.far_bend) * hh;
    float length2 = 0;
    for (int i = 0; i < 3; ++i) {
      const float end = p.s.g[i] + p.s.dg[i] * h;
      length2 += end * end;
    }
    const float y = root_of(length2) + (p.s.third * series.gradient + level.far_g_bend) * hh, x = p.s.f + p.s.df * h;
    if constexpr (Varied) return angle().nominal_within(p, x + bend, y, h) > 0;
    return nominal_margin_at(block.iso, x + bend, y) > 0 &&
           (!block.iso.two_sided || nominal_margin_at(block.iso, max_of(0, x - bend), y) > 0);
  }

  // Deep inside no gradient can bring the field below 1, and f falls at most as if all of it came from the nearest
  // source: f(t + h) >= f(t) (1 + |h| / d)^-n. Beside a source, where sums overflow, a hundredth of the half side stays
  // inside, because cells are no larger than some radii of what is in them (Divider).
  float deep_step(const Sample& p) const {
    constexpr float beside_source = 0.01F;
    if (!exits) return 0;
    if (!(p.s.f < 1e30F)) return beside_source;
    if (!(p.s.f > block.iso.critical)) return 0;
    const float step = 0.98F * p.distance * (inverse_root(block.iso.critical / p.s.f, block.degree) - 1);
    return p.distance < 0.1F * beside_source ? max_of(step, beside_source) : max_of(step, 0);
  }

  // The largest certified step from p in direction `sign`, at most `limit`; 0 when none was found.
  float certified_step(const Sample& p, float sign, float limit) const {
    const float deep = deep_step(p);
    return deep >= limit ? limit : max_of(deep, smooth_step(p, sign, limit));
  }

  float smooth_step(const Sample& p, float sign, float limit) const {
    if (!(limit > 0)) return 0;
    const float most = min_of(limit, 0.85F * p.distance);
    // Margin along the step, to second order: margin - b h - c h^2.
    const float m = static_cast<float>(block.degree);
    const float c = p.x_weight * (p.s.second * m * (m + 1) * 0.5F + level.far_bend) +
                    p.y_weight * (p.s.third * (m + 1) * (m + 2) * 0.5F + level.far_g_bend);
    const float b = -sign * p.slope;
    const auto step_to_zero = [b](float margin, float bend) {
      return 2 * margin / (b + root_of(max_of(0, b * b + 4 * max_of(bend, 0) * margin)) + 1e-20F);
    };
    float model = step_to_zero(p.margin, c);
    if constexpr (Varied) {
      if (p.residual_bend > 0) {  // or with the worst share
        const float left = p.margin - p.residual_drop;
        model = step_to_zero(p.margin, c + p.residual_bend);
        if (left > 0) model = max_of(model, step_to_zero(left, c));
      }
    }
    if (model > 0.8F * most && stays_until(p, sign * most)) return most;
    // Short steps end where the model does; long ones before, because their remainder grows faster than the model.
    float h = min_of(0.985F * model, 0.7F * most);
    if (h > 0 && h < 0.01F * p.distance && stays_until(p, sign * h)) return h;
    h *= 0.86F;
    for (int i = 0; i < 5; ++i, h *= 0.5F)
      if (h > 0 && stays_until(p, sign * h)) return h;
    return 0;
  }
};
