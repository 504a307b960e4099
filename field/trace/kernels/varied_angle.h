// The angle of a place, where alpha varies. Part of block_kernels_<set>.cpp.

struct ShareRange {
  float low, high;
};

struct VariedAngle {
  using Sample = SampleOf<true>;

  const BlockView& block;
  const FieldLevel& level;
  const LocalRay& ray;

  // As Marcher::judge(), with the angle of the place.
  void judge(Sample& p, const Probe& probe, float y, float dy) const {
    const ShareRange ends{nominal_margin_at(block, p.s.f, y, 0), nominal_margin_at(block, p.s.f, y, 1)};
    find_share(p, probe, ends);
    const IsoValue iso(block, p.share, p.share_slope, p.s.f, y, p.s.df, dy);
    p.v = iso.v;
    p.curve = iso.curve;
    p.nominal = iso.curve - iso.v;
    p.x_weight = iso.x_weight;
    p.y_weight = iso.y_weight;
    p.slope = iso.slope;
    p.v_slope = iso.v_slope;
    p.residual_bend = p.share_bend < infinity ? abs_of(iso.share_weight) * p.share_bend : 0;
    p.residual_drop = max_of(abs_of(p.nominal - ends.low), abs_of(p.nominal - ends.high));
    p.s.f += level.f_error;
    p.sure = true;
    p.residual = margin(p, p.s.f, p.y, shares_until(p, 0));
  }

  // Where the two ends of the range tell nearly the same of the place, any share may hold.
  void find_share(Sample& p, const Probe& probe, const ShareRange& ends) const {
    constexpr float apart = 1.5F;
    const float least = ends.low, most = ends.high;
    const bool needed = (level.strands != nullptr || level.angle != nullptr) &&
                        !(min_of(abs_of(least), abs_of(most)) > apart * abs_of(most - least) && least * most > 0);
    if (!needed) {
      p.share = least < most ? 0.0F : 1.0F;  // that at which more is inside
      p.share_slope = 0;
      p.share_bend = infinity;
    } else if (level.angle != nullptr) {
      find_mean_share(p, probe);
    } else {
      const float at[3] = {probe.px[0], probe.py[0], probe.pz[0]};
      const float along[1][3] = {{ray.direction[0], ray.direction[1], ray.direction[2]}};
      const ShareValue<1> value = strand_share(level, block.degree, at, along);
      p.share = value.share;
      p.share_slope = value.slope[0];
      p.share_bend = value.bend;
    }
  }

  // A / f of angle_field.h. With s the share here, D = A - s f is 0 here: bounds of D (B3 of tracing.md, for A and f)
  // over f bound how far A / f moves.
  void find_mean_share(Sample& p, const Probe& probe) const {
    AngleSums a{};
    for_each_list(*level.angle, block.degree, AngleSummer{probe, a});
    RaySums far_part{};
    FarOnRay{*level.angle, ray}.add(p.t, far_part);
    const float inverse = 1 / max_of(p.s.f, 1e-20F), n = static_cast<float>(block.degree);
    p.share = (a.value + far_part.f) * inverse;
    p.share_slope = (a.slope + far_part.df - p.share * p.s.df) * inverse;
    const float second = a.second + p.share * p.s.second, far_bend = level.angle->far_bend + p.share * level.far_bend;
    p.share_bend = (0.5F * n * (n + 1) * second + far_bend) * inverse;
  }

  // By which the share can be off: by the errors of A and f, and by rounding.
  float share_error(const Sample& p) const {
    constexpr float rounded = 1e-5F;
    if (!p.sure) return 0;
    if (level.angle == nullptr) return rounded;
    const float least = p.s.f - 2 * level.f_error;
    return least > 0 ? (level.angle->f_error + p.share * level.f_error) / least + rounded : 1;
  }

  // The shares on [t, t + h]. Fields are at most 1 / (1 - q)^n times what they are here, 1 / (1 - q)^(n + 2) their
  // second derivatives, and of the quotient of such a change and a sum of f, or of products of two, there remains at
  // most (1 - q)^-(4 n + 2) <= 1 / (1 - (4 n + 2) q).
  ShareRange shares_until(const Sample& p, float h) const {
    const float left = 1 - static_cast<float>(4 * block.degree + 2) * abs_of(h) / p.distance;
    if (!(p.share_bend < infinity) || !(left > 0.1F)) return {0, 1};
    const float move = p.share_slope * h, bend = p.share_bend * h * h, growth = 1 / left,
                error = share_error(p) * growth;
    return {p.share + min_of(0, move - bend) * growth - error, p.share + max_of(0, move + bend) * growth + error};
  }

  // Marcher::margin(), nominal_margin_at() and nominally_inside() for all shares of a range: C is largest, and least,
  // at its ends.
  float margin(const Sample& p, float x, float y, const ShareRange& shares) const {
    if (!p.sure) return nominal(x, y, shares);
    return min_of(margin_at(block, x * p.raise, y * p.raise, shares.low),
                  margin_at(block, x * p.raise, y * p.raise, shares.high));
  }
  float nominal(float x, float y, const ShareRange& shares) const {
    return min_of(nominal_margin_at(block, x, y, shares.low), nominal_margin_at(block, x, y, shares.high));
  }
  bool inside(float x, float y, const ShareRange& shares) const {
    return nominally_inside(block, x, y, shares.low) && nominally_inside(block, x, y, shares.high);
  }
};
