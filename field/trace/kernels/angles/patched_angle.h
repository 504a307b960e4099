// The angle of a place, where the share of the range is a polynomial on each part of the way. Part of
// block_kernels_<set>.cpp.

template <class F>
struct PatchedAngle {
  using Sample = SampleOf<Angle::Patched, F>;
  using Mask = MaskOf<F>;

  const BlockView& block;
  const LevelOf<F>& level;
  const ShareOnRun<F>& run;

  // As Sampler::judge(), with the angle of the place.
  void judge(Sample& p, F y, F dy) const {
    p.share = run.at(p.t);
    const AnglePlace<F> place(block.tables, p.share.c[0], p.s.f, y);
    p.residual_bend = abs_of(place.tell(block.tables, p.share.c[1], dy, p) * p.share.c[2]);
    p.s.f += level.f_error();
    p.sure = !Mask{};
    p.residual = margin_within(p, p.s.f, p.y, F{}, !Mask{});
  }

  struct Range {
    F low, high;
  };

  // The shares on [t, t + h]. `error`: by which rounding may be off.
  Range shares_until(const Sample& p, F h, F error) const {
    const F* c = p.share.c;
    const F end = c[1] * h, hh = h * h,
            bend = (abs_of(c[2]) + abs_of(c[3] * h) + abs_of(c[4]) * hh) * hh + run.spread + error;
    return {c[0] + min_of(0.0F, end) - bend, c[0] + max_of(0.0F, end) + bend};
  }

  // Marcher::margin(), nominal_margin_at() and nominally_inside() for all shares on [t, t + h], the last one for all f
  // from x to x_high.
  F margin_within(const Sample& p, F x, F y, F h, Mask asked) const {
    constexpr float rounded = 1e-5F;
    const F raised_x = x * p.raise, raised_y = y * p.raise;
    const Mask right = right_of_reference(raised_x, raised_y, block.degree);
    const Range shares = shares_until(p, h, all_lanes<F>(rounded));
    const F worst = select(right, shares.high, shares.low);
    F margin = AnglePlace<F>(block.tables, worst, raised_x, raised_y).margin();
    const Mask as_summed = asked & !p.sure;
    if (any(as_summed)) margin = select(as_summed, nominal_within(p, x, y, h), margin);
    return margin;
  }
  F nominal_within(const Sample& p, F x, F y, F h) const {
    const Range shares = shares_until(p, h, F{});
    const Mask right = right_of_reference(x, y, block.degree);
    return AnglePlace<F>(block.tables, select(right, shares.high, shares.low), x, y).nominal_margin();
  }
  Mask inside_within(const Sample& p, F x, F x_high, F y, F h) const {
    const Range shares = shares_until(p, h, F{});
    if (block.iso.two_sided)
      return (x > block.iso.critical) | (inside_below_crest(block.tables, shares.low, x, x_high, y) &
                                         inside_below_crest(block.tables, shares.high, x, x_high, y));
    const Mask right = right_of_reference(x, y, block.degree);
    return (x > block.iso.critical) |
           (AnglePlace<F>(block.tables, select(right, shares.low, shares.high), x, y).straight_margin() < 0.0F);
  }
};
