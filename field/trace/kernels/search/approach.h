// Sample by sample: the coarse level comes near the root, the fine level decides. Part of block_kernels_<set>.cpp.

// The coarse level: it finds where the surface may be, at a fraction of the cost.
template <Angle Rule, class F = float>
struct Approach {
  using Mask = MaskOf<F>;

  Search<Rule, F>& s;
  bool any_root;
  F next;                        // where to look
  Mask surely_inside{}, near{};  // of rays that have ended; others are outside all along
  F guess{};                     // of near ones, which are certified up to the front: close to the root

  Approach(Search<Rule, F>& search, bool any) : s(search), any_root(any), next(0.5F * (s.front + s.end)) {}

  // Another sample of each of these rays. Returns those that have not ended.
  Mask step(Mask open) {
    constexpr int most_samples = 200;
    const SampleOf<Rule, F> p = s.march.sample(next, open);
    const F before = s.front;
    s.record(open, p);
    open = open & !s.missed();
    if (any_root) open = open & !find_inside(p, open);
    if (!any(open)) return open;
    next = select(open, s.guess(), next);
    const F gap = s.gap_end() - s.front;
    const Mask found =
        s.bracketed() & ((gap < 0.1F * p.distance) | (s.have_last & (next - s.front < 0.05F * p.distance)));
    const Mask stuck =
        (p.residual > 0.0F) & (s.front - before < 1e-3F * p.distance) & (p.t - before < 1e-2F * p.distance);
    const Mask last = s.march.evaluations >= most_samples;
    const Mask enough = open & (found | (gap < 1e-3F * p.distance) | stuck | last);
    if (any(enough)) come_near(enough);
    return open & !enough;
  }

 private:
  Mask find_inside(const SampleOf<Rule, F>& p, Mask open) {
    const Mask inside = open & (p.residual <= 0.0F);
    if (!any(inside)) return inside;
    const Mask surely = inside & s.march.inside_at(p, F{});
    surely_inside = surely_inside | surely;
    return surely;
  }

  // A little before the root, so that one fine certificate can reach it.
  void come_near(Mask rays) {
    near = near | rays;
    const F root = s.estimated_root(), distance = select(s.have_inside, s.inside.distance, s.last.distance);
    guess = select(rays, select(root < infinity, root - 3e-4F * distance, next), guess);
  }
};

template <class F>
struct RootOf {
  F t{};
  MaskOf<F> hit{};
  F undecided = all_lanes<F>(infinity);
  IntOf<F> evaluations{};
  F searched_from{};
  MaskOf<F> begins_outside{}, enters_inside{};  // as in Root
};

// The fine level: it decides.
template <Angle Rule, class F = float>
struct Decision {
  using Mask = MaskOf<F>;

  Search<Rule, F>& s;
  bool any_root;
  F guess;  // where to look
  IntOf<F> samples{};
  Mask hit{};  // of rays that have ended, at t
  F t{};

  Decision(Search<Rule, F>& search, F first_guess, bool any) : s(search), any_root(any), guess(first_guess) {}

  // Another sample of each of these rays. Returns those that have not ended.
  Mask step(Mask open) {
    const SampleOf<Rule, F> p = s.march.sample(guess, open);
    count(open, samples);
    const F before = s.front;
    s.record(open, p);
    open = open & !s.missed();
    if (!any(open)) return open;
    Mask met = s.pinned(open, t);
    if (any_root) {
      const Mask inside = open & !met & s.have_inside;
      t = select(inside, s.inside.t, t);
      met = met | inside;
    }
    const Mask given_up = open & !met & s.too_short(p);
    if (any(given_up)) met = met | s.give_up_gap(given_up, t);
    hit = hit | met;
    open = open & !met & !s.missed();
    if (any(open)) guess = s.next(p, before, samples);
    return open;
  }

  F undecided() const { return s.undecided_before(select(hit, t, all_lanes<F>(infinity))); }
};
