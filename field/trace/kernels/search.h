// The first root along a stretch of a ray. Part of block_kernels_<set>.cpp.

// `front` is the end of the stretch from t0 that is certified outside; islands are certified stretches beyond it,
// nearest on top; `inside` is the nearest sample known not to be outside.
struct Search {
  static constexpr int most_islands = 8;
  struct Island {
    float begin, end;
    Sample sample;
  };
  Marcher& march;
  float front, end;
  bool have_last = false, have_inside = false;
  float undecided = infinity;  // where the first gap too short to decide was passed over
  Sample last, inside;         // last: the outside sample whose certificate reaches the front
  Island islands[most_islands];
  int island_count = 0;

  Search(Marcher& m, float t0, float t1) : march(m), front(t0), end(t1) {}

  bool missed() const { return !have_inside && front >= end; }
  bool bracketed() const { return have_inside && island_count == 0; }
  float gap_end() const { return island_count > 0 ? islands[island_count - 1].begin : have_inside ? inside.t : end; }

  void reach(float t, const Sample& p) {
    front = t;
    last = p;
    have_last = true;
    while (island_count > 0 && islands[island_count - 1].begin <= front) {
      const Island& top = islands[--island_count];
      if (top.end > front) {
        front = top.end;
        last = top.sample;
      }
    }
  }

  // How far the certificate of p reaches toward `limit`; exactly `limit` when it gets there.
  float certified_end(const Sample& p, float sign, float limit) const {
    const float whole = abs_of(limit - p.t), step = march.certified_step(p, sign, whole);
    return step >= whole ? limit : p.t + sign * step;
  }

  void record(const Sample& p) {
    if (p.residual <= 0) {
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

  // Where to look next. Just before an estimated root, so that one certificate from there closes the gap; else in
  // the middle of the first gap.
  float guess() const {
    const float right = gap_end(), gap = right - front;
    float root = 0.5F * (front + right), back = 0;
    if (have_last && last.slope < 0) {
      const float newton = last.t - last.residual / last.slope;
      if (newton > front && newton < right) {
        root = bracketed() && inside.slope < 0 ? hermite_root(last.residual, inside.residual) : newton;
        back = min_of(0.05F * (root - last.t), 2e-4F * last.distance);
      }
    } else if (bracketed() && inside.slope < 0) {
      const float newton = inside.t - inside.residual / inside.slope;
      if (newton > front && newton < right) {
        root = newton;
        back = 2e-4F * inside.distance;
      }
    }
    const float inset = 0.02F * gap;
    return min_of(max_of(root - back, front + min_of(inset, back + 1e-4F)), right - inset);
  }

  // Where the field as summed, without the level's errors, reaches 1; from the samples at hand.
  float nominal_root() const {
    if (have_last && have_inside && last.slope < 0 && inside.slope < 0 && last.nominal > 0 && inside.nominal < 0)
      return hermite_root(last.nominal, inside.nominal);
    const bool use_last =
        have_last && last.slope < 0 && !(have_inside && abs_of(inside.nominal) < abs_of(last.nominal));
    if (use_last) return last.t - last.nominal / last.slope;
    if (have_inside && inside.slope < 0) return inside.t - inside.nominal / inside.slope;
    return 0.5F * (front + gap_end());
  }

  // The root of the cubic that meets values p0, p1 and slopes at both ends of the bracket.
  float hermite_root(float p0, float p1) const {
    const float h = inside.t - last.t;
    const float d0 = last.slope * h, d1 = inside.slope * h;
    float u = p0 / (p0 - p1);
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

  // Newton's root from the last outside sample, when it is proved: the certificate reaches it to within the
  // shortest gap, the field is above 1 just behind it, and the step is so short that Newton's error, some three
  // times its square over the distance to the skeleton, is below 2e-6 of that distance.
  bool pinned(float& root) const {
    if (!have_last || !(last.slope < 0)) return false;
    const float step = -last.residual / last.slope, tolerance = shortest_gap * last.distance;
    root = last.t + step;
    if (!(step < 8e-4F * last.distance) || !(root - front < tolerance) || !(root <= end)) return false;
    return (bracketed() && inside.t - root < tolerance) || march.inside_at(last, step + tolerance);
  }

  // A gap too short to decide: with an inside sample behind it, its middle is the root; else a grazing touch, left.
  bool give_up_gap(float& root) {
    const float right = gap_end();
    if (bracketed()) {
      root = 0.5F * (front + right);
      return true;
    }
    undecided = min_of(undecided, front);
    reach(right, island_count > 0 ? islands[island_count - 1].sample : last);
    return false;
  }
};

inline constexpr int most_samples = 200;

// The coarse level: it finds where the surface may be, at a fraction of the cost. When it returns Near, the front is
// certified and `guess` is close to the root.
enum class Approach { Missed, SurelyInside, Near };

inline Approach approach(Search& s, bool any, float& guess) {
  float next = 0.5F * (s.front + s.end);
  for (int i = 0; i < most_samples; ++i) {
    const Sample p = s.march.sample(next);
    s.record(p);
    if (s.missed()) return Approach::Missed;
    if (any && p.residual <= 0 && s.march.inside_at(p, 0)) return Approach::SurelyInside;
    next = s.guess();
    const float gap = s.gap_end() - s.front;
    if (s.bracketed() && (gap < 0.1F * p.distance || (s.have_last && next - s.front < 0.05F * p.distance))) break;
    if (gap < 1e-3F * p.distance) break;
  }
  // A little before the root, so that one fine certificate can reach it.
  guess = s.nominal_root() - 3e-4F * (s.have_inside ? s.inside.distance : s.last.distance);
  return Approach::Near;
}

// The fine level: it decides.
inline Root decide(Search& s, float guess, bool any) {
  Root root;
  for (int i = 0; i < most_samples; ++i) {
    const Sample p = s.march.sample(guess);
    s.record(p);
    if (s.missed()) return root;
    root.undecided = s.undecided;
    root.hit = s.pinned(root.t);
    if (!root.hit && any && s.have_inside) {
      root.hit = true;
      root.t = s.inside.t;
    }
    if (root.hit) return root;
    if (s.gap_end() - s.front < shortest_gap * p.distance) {
      root.hit = s.give_up_gap(root.t);
      root.undecided = s.undecided;
      if (root.hit || s.missed()) return root;
    }
    guess = s.guess();
  }
  root.undecided = min_of(s.undecided, s.front);
  root.hit = s.have_inside;
  root.t = s.gap_end();
  return root;
}

Root first_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  float front = query.t0;
  Root root;
  if (query.from_surface) {  // too near for the coarse level; one fine certificate leads away
    Marcher march(block, block.fine, ray, query.t0, query.t1);
    Search start(march, query.t0, query.t1);
    start.record(march.sample(query.t0));
    root.evaluations = march.evaluations;
    if (start.missed()) return root;
    front = start.front;
  }
  Marcher coarse(block, block.coarse, ray, front, query.t1);
  Search far_off(coarse, front, query.t1);
  float guess = front;
  const Approach approached = approach(far_off, query.any, guess);
  root.evaluations += coarse.evaluations;
  if (approached == Approach::Missed) return root;
  if (approached == Approach::SurelyInside) {
    root.hit = true;
    root.t = far_off.inside.t;
    return root;
  }
  Marcher fine(block, block.fine, ray, far_off.front, query.t1);
  Search close(fine, far_off.front, query.t1);
  const int before = root.evaluations;
  root = decide(close, min_of(max_of(guess, far_off.front), query.t1), query.any);
  root.evaluations = before + fine.evaluations;
  return root;
}
