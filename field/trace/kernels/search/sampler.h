// What one place on a ray tells: its sums, and by them on which side of the surface it is. Part of
// block_kernels_<set>.cpp.

// Adds the sources of the level, and its far field, at a place on the ray; `nearest`: the largest 1 / d^2.
inline void add_level(const LevelOf<float>& of, int degree, const OnRay<float> (&p)[3], const LocalRay& ray, bool,
                      RaySums<float>& sums, float& nearest) {
  V16 lanes_nearest{};
  for_each_list(of.level, degree, RaySummer{ray, probe_of(p), lanes_nearest, sums});
  nearest = largest_lane(lanes_nearest);
  add_far(of.level, p, sums);
}

// What gives the angle of a place.
template <Angle Rule, class F>
struct AngleSource {};
template <>
struct AngleSource<Angle::Mean, float> {
  mutable SummedShare last;  // what was summed last
};
template <class F>
struct AngleSource<Angle::Patched, F> {
  const ShareOnRun<F>& run;
};

// An angle for each skeleton is for single rays alone.
template <Angle Rule, class F = float>
struct Sampler {
  using Sample = SampleOf<Rule, F>;
  using Mask = MaskOf<F>;
  using Ray = RayOf<F>;

  const BlockView& block;
  const LevelOf<F>& level;
  const Ray& ray;
  bool exits = false;  // the ray is inside, and what is looked for is where it leaves: all samples are mirrored
  IntOf<F> evaluations{};
  AngleSource<Rule, F> source;

  // All that is read of the block is the same for all blocks of a blend.
  Sampler(const BlockView& b, const LevelOf<F>& l, const Ray& r, const AngleSource<Rule, F>& s)
      : block(b), level(l), ray(r), source(s) {}

  // At t, of the rays that are active.
  Sample sample(F t, Mask active) {
    count(active, evaluations);
    RaySums<F> sums{};
    OnRay<F> at[3];
    for (int k = 0; k < 3; ++k) at[k] = {ray.origin[k] + ray.direction[k] * t, ray.direction[k]};
    F nearest{};
    add_level(level, block.degree, at, ray, active, sums, nearest);
    // At most eight half sides of the block: its scale, where it lists no sources at all.
    return told_by(t, at, sums, 0.99999F / root_of(max_of(nearest, 1.0F / 64)), level.g_error(), 1);
  }

  // What sums tell of the place. `g_error`: how much longer G may be; places are rounded so many times as for a sample.
  Sample told_by(F t, const OnRay<F> (&at)[3], const RaySums<F>& sums, F distance, F g_error, float roundings) {
    Sample p;
    p.t = t;
    p.s = sums;
    p.distance = distance;
    const F y = root_of(dot3(p.s.g, p.s.g)), dy = dot3(p.s.g, p.s.dg) / max_of(y, 1e-12F);
    p.raise = 1 + rounding + roundings * position_rounding * static_cast<float>(block.degree + 1) / p.distance;
    p.y = y + g_error;
    if constexpr (Rule == Angle::Mean) angle().judge(p, at, y, dy);
    else if constexpr (Rule == Angle::Patched) angle().judge(p, y, dy);
    else judge(p, y, dy);
    const Mask infinite = !(p.residual == p.residual);  // on a source
    p.residual = select(infinite, all_lanes<F>(-1), p.residual);
    p.nominal = select(infinite, all_lanes<F>(-1), p.nominal);
    p.nominal = min_of(p.nominal, beyond_critical(p));
    p.sure = p.residual > 0.0F;
    p.margin = select(p.sure, p.residual, p.nominal);
    if (exits) mirror(p);
    scale(p);
    return p;
  }

  // From the critical field on all is inside, whatever G is; there the table may have ended, or u and v may be so large
  // that floats do not tell which side of the curve they are on. What the curve has to tell is never above this, since
  // v grows at least as fast as f.
  F beyond_critical(const Sample& p) const {
    const F beyond = block.iso.critical - (p.s.f - level.f_error());
    return select(beyond < 0.0F, beyond, all_lanes<F>(infinity));
  }

  void judge(Sample& p, F y, F dy) const {
    const IsoCurve::View& iso = block.iso;
    const CurveValue<F> curve = curve_at(iso, turned_u(iso, p.s.f, y));
    const F v = turned_v(iso, p.s.f, y);
    p.nominal = curve.value - v;
    p.x_weight = iso.sin_theta + curve.slope * iso.cos_theta;
    p.y_weight = iso.cos_theta - curve.slope * iso.sin_theta;
    p.slope = -p.x_weight * p.s.df - p.y_weight * dy;
    p.v = v;
    p.v_slope = turned_v(iso, p.s.df, dy);
    p.curve = curve.value;
    p.s.f += level.f_error();
    p.residual = margin_at(iso, p.s.f * p.raise, p.y * p.raise);
  }

  auto angle() const {
    if constexpr (Rule == Angle::Mean) return VariedAngle{block, level.level, ray, source.last};
    else return PatchedAngle<F>{block, level, source.run};
  }

  // What is inside takes the part of what is outside. To within rounding: nothing more is claimed of exits.
  static void mirror(Sample& p) {
    p.margin = p.residual = p.nominal = -p.nominal;
    p.slope = -p.slope;
    p.sure = !Mask{};
  }

  void scale(Sample& p) const {
    const F inverse = 1 / max_of(p.curve, 1e-6F), q = max_of(p.v * inverse, 1e-6F);
    const float side = exits ? -1.0F : 1.0F;                                // of mirrored samples
    const F dq = (p.v_slope - q * (side * p.slope + p.v_slope)) * inverse;  // (v / V)' with V' = residual' + v'
    const F root = inverse_root(q, block.degree - 1);
    p.scaled = side * (root - 1);
    p.scaled_slope = -side * root * dq / (q * static_cast<float>(block.degree - 1));
  }
};
