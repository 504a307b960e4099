// What is known of the first root along a stretch of a ray. Part of block_kernels_<set>.cpp.

// A stretch, and how far it is known only to within rounding; empty at first.
template <class F>
struct Doubt {
  F begin = all_lanes<F>(infinity), end = all_lanes<F>(-infinity);
};

// Certified stretches beyond the front, nearest on top.
template <Angle Rule, class F>
struct Islands {
  using Sample = SampleOf<Rule, F>;
  using Mask = MaskOf<F>;

  // When the stack is full, the nearest is forgotten for one still nearer: the first gap shrinks all the same, so that
  // a search by halves always ends.
  static constexpr int most = 40;
  struct Island {
    F begin, end;
    Sample sample;
  };
  static constexpr bool is_packet = sizeof(F) > sizeof(float);
  std::conditional_t<is_packet, Island*, Island[most]> stack;
  IntOf<F> count{};

  explicit Islands(const RayOf<F>& ray) {
    if constexpr (is_packet) {
      static_assert(sizeof(Island[most]) <= PacketMemory::of_search);
      stack = reinterpret_cast<Island*>(ray.memory->search);
    }
  }

  Mask some() const { return count > 0; }
  void clear(Mask active) { count = select(active, IntOf<F>{}, count); }

  // Calls visit(island, rays) for the topmost ones; all rays of the mask have some.
  template <class Visit>
  void at_top(Mask rays, const Visit& visit) {
    if constexpr (sizeof(F) == sizeof(float)) {
      visit(stack[count - 1], rays);
    } else {
      for (int depth = 0; any(rays); ++depth) {
        const Mask here = rays & (count == depth + 1);
        if (any(here)) visit(stack[depth], here);
        rays = rays & !here;
      }
    }
  }

  void push(Mask rays, F begin, F end, const Sample& sample) {
    count = count + select(rays & (count < most), IntOf<F>{} + 1, IntOf<F>{});
    at_top(rays, [&](Island& top, Mask here) {
      assign(here, top.begin, begin);
      assign(here, top.end, end);
      assign(here, top.sample, sample);
    });
  }
  void pop(Mask rays) { count = count - select(rays, IntOf<F>{} + 1, IntOf<F>{}); }
};

// `front` is the end of the stretch from t0 that is certified outside; `inside` is the nearest sample known not to be
// outside.
template <Angle Rule, class F = float>
struct Search {
  using Sample = SampleOf<Rule, F>;
  using Mask = MaskOf<F>;

  Marcher<Rule, F>& march;
  F front, end;
  Mask have_last{}, have_inside{};
  F undecided = all_lanes<F>(infinity);  // where the first stretch was passed over that could not be decided
  Doubt<F> doubt;                        // the last such stretch, not in `undecided` yet
  Sample last, inside;                   // last: the outside sample whose certificate reaches the front
  Islands<Rule, F> islands;
  F nearest_island{};  // where it begins

  Search(Marcher<Rule, F>& m, F t0, F t1) : march(m), front(t0), end(t1), islands(m.ray) {}

  // Others begin in these lanes.
  void restart(Mask lanes_of, F t0, F t1) {
    assign(lanes_of, front, t0);
    assign(lanes_of, end, t1);
    have_last = have_last & !lanes_of;
    have_inside = have_inside & !lanes_of;
    undecided = select(lanes_of, all_lanes<F>(infinity), undecided);
    doubt.begin = select(lanes_of, all_lanes<F>(infinity), doubt.begin);
    doubt.end = select(lanes_of, all_lanes<F>(-infinity), doubt.end);
    islands.count = select(lanes_of, IntOf<F>{}, islands.count);
  }

  Mask missed() const { return (front >= end) & !have_inside; }
  Mask bracketed() const { return have_inside & !islands.some(); }
  F gap_end() const { return select(islands.some(), nearest_island, select(have_inside, inside.t, end)); }

  void reach(Mask rays, F t, const Sample& p) {
    advance(rays, t, p);
    for (;;) {
      const Mask met = rays & islands.some() & (nearest_island <= front);
      if (!any(met)) return;
      islands.at_top(met, [&](const auto& top, Mask here) { advance(here & (top.end > front), top.end, top.sample); });
      islands.pop(met);
      const Mask more = met & islands.some();
      if (any(more)) islands.at_top(more, [&](const auto& top, Mask here) { assign(here, nearest_island, top.begin); });
    }
  }

  void advance(Mask rays, F t, const Sample& p) {
    pass(rays & !p.sure, t);
    assign(rays, front, t);
    assign(rays, last, p);
    have_last = have_last | rays;
  }

  // What is before t is not decided.
  void pass(Mask rays, F t) {
    if (!any(rays)) return;
    const Mask apart = rays & (front > doubt.end);
    undecided = select(apart, min_of(undecided, doubt.begin), undecided);
    assign(apart, doubt.begin, front);
    assign(rays, doubt.end, t);
  }

  // Where the first stretch lies that was not decided. What ends at the crossing is the crossing, as well as it is
  // known.
  F undecided_before(F crossing) const {
    const F distance = select(have_last, last.distance, select(have_inside, inside.distance, all_lanes<F>(1)));
    const F tolerance = crossing_gap * distance;
    return select(doubt.end + tolerance >= crossing, undecided, min_of(undecided, doubt.begin));
  }

  // How far the certificate of p reaches toward `limit`; exactly `limit` when it gets there.
  F certified_end(Mask rays, const Sample& p, float sign, F limit) const {
    const F whole = abs_of(limit - p.t), step = march.certified_step(p, sign, whole, rays);
    return select(step >= whole, limit, p.t + sign * step);
  }

  void record(Mask rays, const Sample& p) {
    const Mask not_outside = rays & (select(is_exact(march.level), p.nominal, p.residual) <= 0.0F);
    if (any(not_outside)) {
      assign(not_outside, inside, p);
      have_inside = have_inside | not_outside;
      islands.clear(not_outside);
    }
    const Mask outside = rays & !not_outside;
    if (!any(outside)) return;
    const F limit = gap_end();
    const F begin = certified_end(outside, p, -1, front), finish = certified_end(outside, p, 1, limit);
    const Mask from_front = outside & (begin <= front), beyond = outside & !from_front;
    if (any(beyond)) {
      assign(beyond, nearest_island, begin);
      islands.push(beyond, begin, finish, p);
    }
    if (any(from_front)) reach(from_front, finish, p);
  }

  // Where the field as summed, without the level's errors, reaches 1: by the samples at the two ends of the first gap.
  // NaN-free; may lie outside the gap.
  F estimated_root() const {
    const Mask from_last = have_last & (last.scaled_slope < 0.0F),
               from_inside = bracketed() & (inside.scaled_slope < 0.0F);
    F root = all_lanes<F>(infinity);
    if (any(from_inside)) root = select(from_inside, inside.t + inside.newton_step(), root);
    if (any(from_last)) root = select(from_last, last.t + last.newton_step(), root);
    const Mask from_both = from_last & from_inside;
    if (any(from_both)) root = select(from_both, hermite_root(), root);
    return root;
  }

  // The root of the cubic that meets the scaled values and slopes of both samples.
  F hermite_root() const {
    const F h = inside.t - last.t, p0 = last.scaled, p1 = inside.scaled;
    const F d0 = last.scaled_slope * h, d1 = inside.scaled_slope * h;
    F u = p0 / max_of(p0 - p1, 1e-20F);
    for (int k = 0; k < 3; ++k) {
      const F u2 = u * u, u3 = u2 * u;
      const F v = p0 * (1 - 3 * u2 + 2 * u3) + d0 * (u - 2 * u2 + u3) + p1 * (3 * u2 - 2 * u3) + d1 * (u3 - u2);
      const F dv = p0 * (6 * u2 - 6 * u) + d0 * (1 - 4 * u + 3 * u2) + p1 * (6 * u - 6 * u2) + d1 * (3 * u2 - 2 * u);
      u = select(dv < 0.0F, u - v / dv, u);
      u = min_of(1.0F, max_of(0.0F, u));
    }
    return last.t + u * h;
  }

  F distance_at_gap() const { return select(have_last, last.distance, inside.distance); }

  // Where to look next: just before an estimated root in the first gap, so that one certificate from there closes the
  // gap; else in the gap's middle.
  F guess() const {
    const F right = gap_end(), gap = right - front, root = estimated_root(), distance = distance_at_gap();
    const F back = 2e-4F * distance + select(bracketed(), F{}, 0.02F * (root - front));
    const F inset = 0.02F * gap;
    const F least = min_of(min_of(inset, 1e-4F * distance), 0.5F * (root - front));
    return select((root > front) & (root < right), min_of(max_of(root - back, front + least), right - inset),
                  0.5F * (front + right));
  }

  // Whether a sample tells the field of its place. Where skeletons have an angle each and the ends of their range tell
  // nearly the same it tells that of one end.
  static Mask is_told([[maybe_unused]] const Sample& p) {
    if constexpr (Rule == Angle::Mean) return VariedAngle::known(p);
    else return !Mask{};
  }

  // The root between two samples near by, by the cubic through both, or Newton's from the last outside one, when it is
  // proved: the certificate reaches it to within the shortest gap, and the field is above 1 just behind it. Both go so
  // short a way that C is off by some 1e-6: where several skeletons bend the scaled field, a step of h distances is off
  // by (m h)^2 / 2, m = degree - 1, and the cubic by (m h)^4 / 384. Near one it is straight but for the third order.
  Mask pinned(Mask rays, F& root) const {
    const float m = static_cast<float>(march.block.degree - 1);
    const float longest_step = 6e-4F * (m > 3 ? 3 / m : 1), longest_between = 0.02F * (m > 5 ? 5 / m : 1);
    rays = rays & have_last & is_told(last);
    if (!any(rays)) return rays;
    const F tolerance = shortest_gap * last.distance;
    const Mask between = rays & bracketed() & is_told(inside) & (inside.t - last.t < longest_between * last.distance) &
                         (inside.scaled_slope < 0.0F);
    F step = last.newton_step();
    if (any(between)) step = select(between, hermite_root() - last.t, step);
    root = select(rays, max_of(front, last.t + step), root);
    const Mask close = rays & (last.scaled_slope < 0.0F) & (between | (step < longest_step * last.distance)) &
                       (root - front < tolerance) & (root <= end);
    if (!any(close)) return close;
    const Mask ends = close & bracketed() & (inside.t - root < tolerance), open = close & !ends;
    return any(open) ? ends | (open & march.crossed_at(last, step + tolerance)) : ends;
  }

  // A gap too short to decide: with an inside sample behind it, it holds the root; else a grazing touch, left.
  Mask give_up_gap(Mask rays, F& root) {
    const F right = gap_end();
    const Mask holds = rays & bracketed();
    if (any(holds)) {
      const F estimate = estimated_root();
      const F nearest = min_of(max_of(estimate, front), right);
      root = select(holds, select(estimate < infinity, nearest, 0.5F * (front + right)), root);
    }
    const Mask touch = rays & !holds;
    if (!any(touch)) return holds;
    pass(touch, right);
    const Mask before_island = touch & islands.some(), at_end = touch & !before_island;
    assign(at_end, front, right);
    if (any(before_island)) {
      Sample begin = last;
      islands.at_top(before_island, [&](const auto& top, Mask here) { assign(here, begin, top.sample); });
      reach(before_island, right, begin);
    }
    return holds;
  }

  // Whether the first gap is given up, where p is.
  Mask too_short(const Sample& p) const {
    const F right = gap_end(), middle = 0.5F * (front + right);
    const F least = select(bracketed(), all_lanes<F>(shortest_gap), all_lanes<F>(shortest_gap_between));
    return (right - front < least * p.distance) | !((middle > front) & (middle < right));
  }

  // The next place after `samples` of them, p the last. Newton's guesses are quick unless the field stays near 1 over a
  // long way; halving the first gap always ends, because each half ends at a sample.
  F next(const Sample& p, F before, IntOf<F> samples) const {
    constexpr int patience = 48;
    F place = guess();
    // Where the field all but touches 1 certificates are short: look from the other side of the touch.
    const Mask touching = (p.margin > 0.0F) & (front - before < shortest_gap * p.distance);
    if (any(touching)) place = select(touching, front + min_of(0.5F * (gap_end() - front), 1e-3F * p.distance), place);
    return select(samples >= patience, 0.5F * (front + gap_end()), place);
  }
};
