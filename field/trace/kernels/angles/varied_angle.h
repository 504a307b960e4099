// The angle of a place, where each skeleton has one. Part of block_kernels_<set>.cpp.

struct ShareRange {
  float low, high;
};

struct VariedAngle {
  using Sample = SampleOf<Angle::Mean>;

  const BlockView& block;
  const FieldLevel& level;
  const LocalRay& ray;
  SummedShare& last;  // that was summed on the ray

  // As Sampler::judge(), with the angle of the place.
  void judge(Sample& p, const OnRay<float> (&at)[3], float y, float dy) const {
    const AnglePlace<float> least(block.tables, 0, p.s.f, y), most(block.tables, 1, p.s.f, y);
    const float low = least.nominal_margin(), high = most.nominal_margin();
    p.summed = {};
    if (needs_share(low, high)) p.summed = share_at(p, at);
    const SummedShare& here = p.summed;
    p.residual_bend = 0;
    if (known(p)) {
      const AnglePlace<float> place(block.tables, here.share + here.slope * (p.t - here.t), p.s.f, y);
      p.residual_bend = abs_of(place.tell(block.tables, here.slope, dy, p)) * here.bend;
    } else {
      (low > high ? most : least).tell(block.tables, 0, dy, p);
    }
    p.residual_drop = max_of(0, p.nominal - min_of(low, high));
    p.s.f += level.f_error;
    p.sure = true;
    p.residual = margin_within(p, p.s.f, p.y, 0, true);
  }

  // Else any share that may be may hold.
  static bool known(const Sample& p) { return p.summed.bend < infinity; }

  // Not where both ends of the range tell nearly the same of the place.
  bool needs_share(float low, float high) const {
    constexpr float apart = 1.5F;
    return level.angle != nullptr &&
           !(min_of(abs_of(low), abs_of(high)) > apart * abs_of(high - low) && low * high > 0);
  }

  // The one that was summed last serves where it tells this place as well.
  SummedShare share_at(const Sample& p, const OnRay<float> (&at)[3]) const {
    // C changes by up to degree - 1 times as much as the angle.
    const float known_to = 3e-6F / static_cast<float>(block.degree - 1), h = p.t - last.t;
    if (last.bend * h * h < known_to && abs_of(h) < 0.02F * last.distance) return last;
    last = mean_share(p, at);
    return last;
  }

  // A / f of angle_field.h. With s the share here, D = A - s f is 0 here: bounds of D (taylor_remainder.h, of A and f)
  // over f bound how far A / f moves.
  SummedShare mean_share(const Sample& p, const OnRay<float> (&at)[3]) const {
    AngleSums a{};
    for_each_list(*level.angle, block.degree, AngleSummer{probe_of(at), a});
    RaySums<float> far_part{};
    add_far(*level.angle, at, far_part);
    const float inverse = 1 / max_of(p.s.f, 1e-20F), n = static_cast<float>(block.degree);
    const float share = (a.value + far_part.f) * inverse, second = a.second + share * p.s.second,
                far_bend = level.angle->far_bend + share * level.far_bend;
    return {share, (a.slope + far_part.df - share * p.s.df) * inverse,
            (0.5F * n * (n + 1) * second + far_bend) * inverse, p.t, p.distance};
  }

  // By which the share can be off: by the errors of A and f, and by rounding.
  float share_error(const Sample& p) const {
    constexpr float rounded = 1e-5F;
    if (!p.sure) return 0;
    const float least = p.s.f - 2 * level.f_error;
    return least > 0 ? (level.angle->f_error + p.summed.share * level.f_error) / least + rounded : 1;
  }

  // The shares on [t, t + h]. With q the largest distance from where they were summed, over that to the nearest source
  // there, fields are at most (1 - q)^-n times what they are there, their second derivatives (1 - q)^-(n + 2), and of
  // the quotient of such a change and a sum of f at most (1 - q)^-(6 n + 2) remains.
  ShareRange shares_until(const Sample& p, float h) const {
    if (!known(p)) return {0, 1};
    const SummedShare& from = p.summed;
    const float begin = p.t - from.t, end = begin + h, longest = max_of(abs_of(begin), abs_of(end));
    const float q = longest / from.distance;
    if (!(q < 0.1F)) return {0, 1};
    const float growth = power_of(1 / (1 - q), 6 * block.degree + 2);
    const float bend = from.bend * longest * longest, error = share_error(p) * growth;
    const float a = from.slope * begin, b = from.slope * end;
    return {from.share + min_of(0, min_of(a, b) - bend) * growth - error,
            from.share + max_of(0, max_of(a, b) + bend) * growth + error};
  }

  // Where the field is largest of all shares on [t, t + h], or least.
  AnglePlace<float> place_within(const Sample& p, float x, float y, float h, bool largest) const {
    const ShareRange shares = shares_until(p, h);
    const bool upper = right_of_reference(x, y, block.degree) == largest;
    return AnglePlace<float>(block.tables, upper ? shares.high : shares.low, x, y);
  }

  // Marcher::margin(), nominal_margin_at() and nominally_inside() for all shares on [t, t + h], the last one for all f
  // from x to x_high.
  float margin_within(const Sample& p, float x, float y, float h, bool) const {
    if (!p.sure) return nominal_within(p, x, y, h);
    return place_within(p, x * p.raise, y * p.raise, h, true).margin();
  }
  float nominal_within(const Sample& p, float x, float y, float h) const {
    return place_within(p, x, y, h, true).nominal_margin();
  }
  bool inside_within(const Sample& p, float x, float x_high, float y, float h) const {
    if (x > block.iso.critical) return true;
    if (!block.iso.two_sided) return place_within(p, x, y, h, false).straight_margin() < 0;
    const ShareRange shares = shares_until(p, h);
    return inside_below_crest(block.tables, shares.low, x, x_high, y) &&
           inside_below_crest(block.tables, shares.high, x, x_high, y);
  }
};
