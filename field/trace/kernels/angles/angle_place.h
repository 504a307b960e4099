// Reading the tables of a range of angles, for one ray or a packet (curve/angle_tables.h). Part of
// block_kernels_<set>.cpp.

// What is known of each step of the range.
inline float of_step(const float* numbers, int, int step) { return numbers[step]; }
inline PacketFloat of_step(const float* numbers, int count, PacketInt step) {
#if defined(__AVX512F__)
  if (count <= 2 * lanes) {
    Native first, second;
    __builtin_memcpy(&first, numbers, sizeof first);
    __builtin_memcpy(&second, numbers + lanes, sizeof second);
    return __builtin_shuffle(first, second, static_cast<NativeInt>(step));
  }
#else
  if (count <= lanes) return picked(numbers, step);
#endif
  return gather(numbers, step);
}

// Eight numbers that follow each other, of each ray.
template <class F>
struct EightNumbers {
  F low[4], high[4];
};
// Together for each lane: gathers take a machine many times as long. Rows have lanes 4 k + i in quarter k of row i.
template <class AddressOfLane>
inline EightNumbers<PacketFloat> eight_of_lanes(const AddressOfLane& of_lane) {
  Native low[4], high[4];
  for (int i = 0; i < 4; ++i) {
#if defined(__AVX512F__)
    const auto two = [&](int lane) {
      const V8 a = load8(of_lane(lane)), b = load8(of_lane(lane + 4));
      return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    };
    const Native a = two(i), b = two(i + 8);
    low[i] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
    high[i] = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
#elif defined(__AVX__)
    const Native a = load8(of_lane(i)), b = load8(of_lane(i + 4));
    low[i] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
    high[i] = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
#else
    low[i] = load4(of_lane(i));
    high[i] = load4(of_lane(i) + 4);
#endif
  }
  Native of_low[4], of_high[4];
  transpose_quarters(low, of_low);
  transpose_quarters(high, of_high);
  return {{of_low[0], of_low[1], of_low[2], of_low[3]}, {of_high[0], of_high[1], of_high[2], of_high[3]}};
}

// Four numbers at an entry, and four at the next one.
inline EightNumbers<float> entries_at(const float* table, int entry) {
  const float* p = table + 4 * static_cast<long>(entry);
  return {{p[0], p[1], p[2], p[3]}, {p[4], p[5], p[6], p[7]}};
}
inline EightNumbers<PacketFloat> entries_at(const float* table, PacketInt entry) {
  return eight_of_lanes([&](int lane) { return table + 4 * static_cast<long>(entry[lane]); });
}

// Where a share of the range is on its step.
template <class F>
struct AngleStep {
  IntOf<F> index;
  F s;

  // In lanes without a ray the share may be anything, even no number.
  AngleStep(const AngleTables& tables, F share) {
    const float steps = static_cast<float>(tables.count);
    const F at = min_of(max_of(share, 0.0F), 1.0F) * steps;
    index = whole_part(min_of(at, all_lanes<F>(steps - 0.5F)));
    s = at - to_float(index) - 0.5F;
  }
  F number(const AngleTables& tables, const float* of) const { return of_step(of, tables.count, index); }
  // A quadratic in s, and how it changes with s.
  F at(F a, F b, F c) const { return a + s * (b + s * c); }
  F growth(F b, F c) const { return b + 2 * s * c; }
};

// f and |G| on the curve of their angle, which may be another one in each lane.
template <class F>
struct AnglePlace {
  AngleStep<F> step;
  F sine, cosine, v, last;
  F from_begin, begin_growth, inverse_step, inverse_growth;
  F at, fraction;
  IntOf<F> entry;
  EightNumbers<F> sides;

  AnglePlace(const AngleTables& tables, F share, F x, F y) : step(tables, share) {
    const auto number = [&](const float* of) { return step.number(tables, of); };
    sine = number(tables.sin_theta);
    cosine = number(tables.cos_theta);
    last = number(tables.last);
    const F b = number(tables.begin[1]), c = number(tables.begin[2]);
    const F d = number(tables.inverse_step[1]), e = number(tables.inverse_step[2]);
    v = x * sine + y * cosine;
    from_begin = y * sine - x * cosine - step.at(number(tables.begin[0]), b, c);
    inverse_step = step.at(number(tables.inverse_step[0]), d, e);
    begin_growth = step.growth(b, c);
    inverse_growth = step.growth(d, e);
    at = from_begin * inverse_step;
    const F from = max_of(at, 0.0F);
    const IntOf<F> index = whole_part(min_of(from, last - 0.5F));
    fraction = from - to_float(index);
    entry = step.index * tables.stride + index;
    sides = entries_at(tables.entries, entry);
  }

  F value_at(const F (&of)[4]) const { return step.at(of[0], of[1], of[2]); }
  F growth_at(const F (&of)[4]) const { return step.growth(of[1], of[2]); }
  F difference() const { return value_at(sides.high) - value_at(sides.low); }
  F between(F a, F b) const { return a + (b - a) * fraction; }
  MaskOf<F> beyond() const { return at >= last; }

  F value() const { return between(value_at(sides.low), value_at(sides.high)); }
  // Positive only where the field is certainly below 1.
  F margin() const { return unless_beyond(value() - between(sides.low[3], sides.high[3]) - v); }
  F nominal_margin() const { return unless_beyond(straight_margin()); }
  // Beyond the end by its straight continuation, see nominally_inside() of one table.
  F straight_margin() const { return value() - v; }
  // Before the first entry the curve goes on level.
  F slope() const { return select(at > 0.0F, difference() * inverse_step, F{}); }
  // Of value(), by the share.
  F growth(const AngleTables& tables) const {
    const F of_entries = between(growth_at(sides.low), growth_at(sides.high));
    const F of_place = difference() * (from_begin * inverse_growth - begin_growth * inverse_step);
    return (of_entries + select(at > 0.0F, of_place, F{})) * static_cast<float>(tables.count);
  }
  // Tells a sample of f and |G| by the curve, where the share has a slope along the ray. Returns how the residual grows
  // with the share.
  template <class Sample>
  F tell(const AngleTables& tables, F share_slope, F dy, Sample& p) const {
    const F along = slope(), of_share = growth(tables);
    p.curve = value();
    p.v = v;
    p.x_weight = sine + along * cosine;
    p.y_weight = cosine - along * sine;
    p.v_slope = p.s.df * sine + dy * cosine;
    p.slope = of_share * share_slope - p.x_weight * p.s.df - p.y_weight * dy;
    p.nominal = p.curve - p.v;
    return of_share;
  }
  // Of the curve itself, from its slopes at the entries; level beyond the last one.
  F exact_slope(const AngleTables& tables) const {
    const EightNumbers<F> slopes = entries_at(tables.slopes, entry);
    const F a = value_at(slopes.low), b = value_at(slopes.high);
    return a + (b - a) * min_of(fraction, 1.0F);
  }

 private:
  F unless_beyond(F margin) const { return select(beyond(), all_lanes<F>(-infinity), margin); }
};

// Whether C > 1 for f from x_low to x_high and all G from y on, where angles may be below 0: at the crest of the curve
// over f, or where the range comes nearest to it.
template <class F>
inline MaskOf<F> inside_below_crest(const AngleTables& tables, F share, F x_low, F x_high, F y) {
  const AngleStep<F> step(tables, share);
  const auto within = [&](const float* of) { return min_of(max_of(step.number(tables, of), x_low), x_high); };
  const F from = within(tables.crest_from), to = within(tables.crest_to);
  return AnglePlace<F>(tables, share, from, y - step.number(tables, tables.rise) * (to - from)).straight_margin() <
         0.0F;
}

// Whether f is more than the reference curve has at this |G|: right of it C rises with the angle, left of it it falls
// (iso_curve.h), so that over a range of angles C is largest, and least, at one end. Where float cannot tell the side,
// C hardly depends on the angle.
template <class F>
inline MaskOf<F> right_of_reference(F x, F y, int degree) {
  return power_of(x, degree) > power_of(y * (1 / static_cast<float>(degree - 1)), degree - 1);
}
