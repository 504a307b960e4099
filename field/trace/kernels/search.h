// The first root along a stretch of a ray. Part of block_kernels_<set>.cpp.

// A stretch, and how far it is known only to within rounding; empty at first.
struct Doubt {
  float begin = infinity, end = -infinity;
};

// `front` is the end of the stretch from t0 that is certified outside; islands are certified stretches beyond it,
// nearest on top; `inside` is the nearest sample known not to be outside.
template <bool Varied>
struct Search {
  using Sample = SampleOf<Varied>;
  using Scaled = typename Marcher<Varied>::Scaled;

  // Bisection halves the first gap before it adds an island: down to shortest_gap that is some 20 on top of the others.
  static constexpr int most_islands = 40;
  struct Island {
    float begin, end;
    Sample sample;
  };
  Marcher<Varied>& march;
  float front, end;
  bool have_last = false, have_inside = false;
  bool exact;                  // the level is the field itself: it tells what is inside
  float undecided = infinity;  // where the first stretch was passed over that could not be decided
  Doubt doubt;                 // the last such stretch, not in `undecided` yet
  Sample last, inside;         // last: the outside sample whose certificate reaches the front
  Island islands[most_islands];
  int island_count = 0;

  Search(Marcher<Varied>& m, float t0, float t1)
      : march(m), front(t0), end(t1), exact(!(m.level.f_error > 0) && !(m.level.g_error > 0)) {}

  bool missed() const { return !have_inside && front >= end; }
  bool bracketed() const { return have_inside && island_count == 0; }
  float gap_end() const { return island_count > 0 ? islands[island_count - 1].begin : have_inside ? inside.t : end; }

  void reach(float t, const Sample& p) {
    advance(t, p);
    while (island_count > 0 && islands[island_count - 1].begin <= front) {
      const Island& top = islands[--island_count];
      if (top.end > front) advance(top.end, top.sample);
    }
  }

  void advance(float t, const Sample& p) {
    if (!p.sure) pass(t);
    front = t;
    last = p;
    have_last = true;
  }

  // What is before t is not decided.
  void pass(float t) {
    if (front > doubt.end) {
      undecided = min_of(undecided, doubt.begin);
      doubt.begin = front;
    }
    doubt.end = t;
  }

  // Where the first stretch lies that was not decided. What ends at the crossing is the crossing, as well as it is
  // known.
  float undecided_before(float crossing) const {
    const float tolerance = 2 * shortest_gap * (have_last ? last.distance : have_inside ? inside.distance : 1);
    return doubt.end + tolerance >= crossing ? undecided : min_of(undecided, doubt.begin);
  }

  // How far the certificate of p reaches toward `limit`; exactly `limit` when it gets there.
  float certified_end(const Sample& p, float sign, float limit) const {
    const float whole = abs_of(limit - p.t), step = march.certified_step(p, sign, whole);
    return step >= whole ? limit : p.t + sign * step;
  }

  void record(const Sample& p) {
    if ((exact ? p.nominal : p.residual) <= 0) {
      inside = p;
      have_inside = true;
      island_count = 0;
      return;
    }
    const float limit = gap_end();
    const float begin = certified_end(p, -1, front), finish = certified_end(p, 1, limit);
    if (begin <= front) reach(finish, p);
    else if (island_count < most_islands) islands[island_count++] = {begin, finish, p};
  }

  // Where the field as summed, without the level's errors, reaches 1: by the samples at the two ends of the first gap.
  // NaN-free; may lie outside the gap.
  float estimated_root() const {
    Scaled before{}, behind{};
    if (have_last) before = march.scaled(last);
    if (bracketed()) behind = march.scaled(inside);
    const bool from_last = before.slope < 0, from_inside = behind.slope < 0;
    if (from_last && from_inside) return hermite_root(before, behind);
    if (from_last) return last.t + before.newton_step();
    if (from_inside) return inside.t + behind.newton_step();
    return infinity;
  }

  // The root of the cubic that meets the scaled values and slopes of both samples.
  float hermite_root(const Scaled& before, const Scaled& behind) const {
    const float h = inside.t - last.t, p0 = before.value, p1 = behind.value;
    const float d0 = before.slope * h, d1 = behind.slope * h;
    float u = p0 / max_of(p0 - p1, 1e-20F);
    for (int k = 0; k < 3; ++k) {
      const float u2 = u * u, u3 = u2 * u;
      const float v = p0 * (1 - 3 * u2 + 2 * u3) + d0 * (u - 2 * u2 + u3) + p1 * (3 * u2 - 2 * u3) + d1 * (u3 - u2);
      const float dv =
          p0 * (6 * u2 - 6 * u) + d0 * (1 - 4 * u + 3 * u2) + p1 * (6 * u - 6 * u2) + d1 * (3 * u2 - 2 * u);
      if (dv < 0) u -= v / dv;
      u = min_of(1, max_of(0, u));
    }
    return last.t + u * h;
  }

  // Where to look next: just before an estimated root in the first gap, so that one certificate from there closes the
  // gap; else in the gap's middle.
  float guess() const {
    const float right = gap_end(), gap = right - front, root = estimated_root();
    if (!(root > front && root < right)) return 0.5F * (front + right);
    const float distance = have_last ? last.distance : inside.distance;
    const float back = 2e-4F * distance + (bracketed() ? 0 : 0.02F * (root - front));
    const float inset = 0.02F * gap;
    const float least = min_of(min_of(inset, 1e-4F * distance), 0.5F * (root - front));
    return min_of(max_of(root - back, front + least), right - inset);
  }

  // Newton's root from the last outside sample, when it is proved: the certificate reaches it to within the shortest
  // gap, and the field is above 1 just behind it. The step is so short that the scaled Newton step, whose error is of
  // third order, is exact to float.
  bool pinned(float& root) const {
    if (!have_last) return false;
    const Scaled scaled = march.scaled(last);
    const float step = scaled.newton_step(), tolerance = shortest_gap * last.distance;
    root = max_of(front, last.t + step);
    if (!(scaled.slope < 0) || !(step < 1.2e-3F * last.distance)) return false;
    if (!(root - front < tolerance) || !(root <= end)) return false;
    return (bracketed() && inside.t - root < tolerance) || march.crossed_at(last, step + tolerance);
  }

  // A gap too short to decide: with an inside sample behind it, it holds the root; else a grazing touch, left.
  bool give_up_gap(float& root) {
    const float right = gap_end();
    if (bracketed()) {
      const float estimate = estimated_root();
      root = estimate >= front && estimate <= right ? estimate : 0.5F * (front + right);
      return true;
    }
    pass(right);
    if (island_count > 0) reach(right, islands[island_count - 1].sample);
    else front = right;
    return false;
  }

  // Nothing can be told of gaps shorter than this, where p is.
  bool too_short(const Sample& p) const {
    const float right = gap_end(), middle = 0.5F * (front + right);
    return right - front < shortest_gap * p.distance || !(middle > front && middle < right);
  }

  // The next place after `samples` of them, p the last. Newton's guesses are quick unless the field stays near 1 over a
  // long way; halving the first gap always ends, because each half ends at a sample.
  float next(const Sample& p, float before, int samples) const {
    constexpr int patience = 48;
    if (samples >= patience) return 0.5F * (front + gap_end());
    // Where the field all but touches 1 certificates are short: look from the other side of the touch.
    if (p.margin > 0 && front - before < shortest_gap * p.distance)
      return front + min_of(0.5F * (gap_end() - front), 1e-3F * p.distance);
    return guess();
  }
};

// The coarse level: it finds where the surface may be, at a fraction of the cost. When it returns Near, the front is
// certified and `guess` is close to the root.
enum class Approach { Missed, SurelyInside, Near };

template <bool Varied>
inline Approach approach(Search<Varied>& s, bool any, float& guess) {
  constexpr int most_samples = 200;
  float next = 0.5F * (s.front + s.end);
  for (int i = 0; i < most_samples; ++i) {
    const SampleOf<Varied> p = s.march.sample(next);
    const float before = s.front;
    s.record(p);
    if (s.missed()) return Approach::Missed;
    if (any && p.residual <= 0 && s.march.inside_at(p, 0)) return Approach::SurelyInside;
    next = s.guess();
    const float gap = s.gap_end() - s.front;
    if (s.bracketed() && (gap < 0.1F * p.distance || (s.have_last && next - s.front < 0.05F * p.distance))) break;
    const bool stuck = p.residual > 0 && s.front - before < 1e-3F * p.distance && p.t - before < 1e-2F * p.distance;
    if (gap < 1e-3F * p.distance || stuck) break;
  }
  // A little before the root, so that one fine certificate can reach it.
  const float root = s.estimated_root();
  guess = root < infinity ? root - 3e-4F * (s.have_inside ? s.inside.distance : s.last.distance) : next;
  return Approach::Near;
}

// The fine level: it decides.
template <bool Varied>
inline Root decide(Search<Varied>& s, float guess, bool any) {
  Root root;
  for (int samples = 1; !root.hit && !s.missed(); ++samples) {
    const SampleOf<Varied> p = s.march.sample(guess);
    const float before = s.front;
    s.record(p);
    if (s.missed()) break;
    root.hit = s.pinned(root.t);
    if (!root.hit && any && s.have_inside) {
      root.hit = true;
      root.t = s.inside.t;
    }
    if (!root.hit && s.too_short(p)) root.hit = s.give_up_gap(root.t);
    guess = s.next(p, before, samples);
  }
  root.undecided = s.undecided_before(root.hit ? root.t : infinity);
  return root;
}
