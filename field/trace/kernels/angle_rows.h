// Reading the tables of a range of angles, for one ray or a packet (iso_curve.h). Part of block_kernels_<set>.cpp.

// What is known of each table.
inline float of_row(const float* numbers, int, int row) { return numbers[row]; }
inline PacketFloat of_row(const float* numbers, int count, PacketInt row) {
  return count > lanes ? gather(numbers, row) : picked(numbers, row);
}

// From one entry of a table to the next.
template <class F>
struct TableStep {
  F value, lower, next_value, next_lower;
};
inline TableStep<float> step_at(const float* steps, int entry) {
  const float* s = steps + 4 * static_cast<long>(entry);
  return {s[0], s[1], s[2], s[3]};
}
// Four numbers at a time for each lane: gathers take a machine many times as long.
inline TableStep<PacketFloat> step_at(const float* steps, PacketInt entry) {
  constexpr int quarters = packet_lanes / 4;
  PacketFloat rows[4], columns[4];  // lanes 4 k + i in quarter k of row i
  for (int i = 0; i < 4; ++i) {
    V4 quarter[quarters];
    for (int k = 0; k < quarters; ++k) quarter[k] = load4(steps + 4 * static_cast<long>(entry[4 * k + i]));
    __builtin_memcpy(&rows[i], quarter, sizeof rows[i]);
  }
  transpose_quarters(rows, columns);
  return {columns[0], columns[1], columns[2], columns[3]};
}

// A place in one of the tables, which may be another one in each lane.
template <class F>
struct RowPlace {
  F sine, cosine, v, inverse_step, last, at, fraction;
  IntOf<F> entry;
  TableStep<F> step;

  RowPlace(const AngleTables& tables, IntOf<F> row, F x, F y)
      : sine(of_row(tables.sin_theta, tables.count, row)),
        cosine(of_row(tables.cos_theta, tables.count, row)),
        v(x * sine + y * cosine),
        inverse_step(of_row(tables.inverse_step, tables.count, row)),
        last(of_row(tables.last, tables.count, row)) {
    at = (y * sine - x * cosine - of_row(tables.u_begin, tables.count, row)) * inverse_step;
    const F from = max_of(at, 0.0F);
    const IntOf<F> index = whole_part(min_of(from, last - 0.5F));
    fraction = from - to_float(index);
    entry = row * tables.stride + index;
    step = step_at(tables.steps, entry);
  }
  F slope() const { return step.next_value - step.value; }
  F value() const { return step.value + slope() * fraction; }
  F lower() const { return step.lower + (step.next_lower - step.lower) * fraction; }
  MaskOf<F> beyond() const { return at >= last; }
  // Of the curve itself, from its slopes at the entries; level beyond the last one.
  F exact_slope(const AngleTables& tables) const {
    const F low = gather(tables.slopes, entry);
    return low + (gather(tables.slopes + 1, entry) - low) * min_of(fraction, 1.0F);
  }
};

// All that the tables give is cubic in the share of the range, through the four around it.
template <class F>
struct AngleRows {
  const AngleTables& tables;
  IntOf<F> first;
  F weight[4], slope[4];  // of the tables, and their derivatives by the share

  // In lanes without a ray the share may be anything, even no number.
  AngleRows(const AngleTables& t, F share) : tables(t) {
    const float steps = static_cast<float>(t.count - 1);
    const F at = min_of(max_of(share, 0.0F), 1.0F) * steps;
    const IntOf<F> none{}, last = none + (t.count - 4);
    first = whole_part(at) - 1;
    first = select(first > last, last, first);
    first = select(first < 0, none, first);
    // Lagrange's polynomials for nodes at 0, 1, 2, 3
    const F a = at - to_float(first), b = a - 1.0F, c = a - 2.0F, d = a - 3.0F;
    const F ab = a * b, cd = c * d;
    weight[0] = b * cd * (-1.0F / 6);
    weight[1] = a * cd * 0.5F;
    weight[2] = ab * d * -0.5F;
    weight[3] = ab * c * (1.0F / 6);
    slope[0] = (cd + b * (c + d)) * (-steps / 6);
    slope[1] = (cd + a * (c + d)) * (0.5F * steps);
    slope[2] = (ab + d * (a + b)) * (-0.5F * steps);
    slope[3] = (ab + c * (a + b)) * (steps / 6);
  }
  RowPlace<F> place(int i, F x, F y) const { return {tables, first + i, x, y}; }

  // As margin_at() of one table.
  F margin(F x, F y) const {
    F sum{};
    MaskOf<F> beyond{};
    for (int i = 0; i < 4; ++i) {
      const RowPlace<F> p = place(i, x, y);
      const F value = p.value(), lower = p.lower();
      sum += weight[i] * (value - p.v) - abs_of(weight[i]) * (value - lower);
      beyond = beyond | p.beyond();
    }
    return select(beyond, all_lanes<F>(-infinity), sum);
  }
  F nominal_margin(F x, F y) const {
    F sum{};
    MaskOf<F> beyond{};
    for (int i = 0; i < 4; ++i) {
      const RowPlace<F> p = place(i, x, y);
      sum += weight[i] * (p.value() - p.v);
      beyond = beyond | p.beyond();
    }
    return select(beyond, all_lanes<F>(-infinity), sum);
  }
  // Beyond the end of a table by its straight continuation, see nominally_inside() of one table.
  MaskOf<F> nominally_inside(F x, F y) const {
    F sum{};
    for (int i = 0; i < 4; ++i) {
      const RowPlace<F> p = place(i, x, y);
      sum += weight[i] * (p.value() - p.v);
    }
    return sum < 0.0F;
  }
};

// By one table, whose angle is not nearer to the surface than any up to the share: `upward`, or down to it.
template <class F>
inline F margin_of_next_row(const AngleTables& tables, MaskOf<F> upward, F share, F x, F y) {
  const F at = min_of(max_of(share, 0.0F), 1.0F) * static_cast<float>(tables.count - 1);
  const IntOf<F> below = whole_part(at);
  const IntOf<F> row = select(upward & (to_float(below) < at), below + 1, below);
  const RowPlace<F> p(tables, row, x, y);
  return select(p.beyond(), all_lanes<F>(-infinity), p.lower() - p.v);
}

// Whether f is more than the reference curve has at this |G|: right of it C rises with the angle, left of it it falls
// (iso_curve.h), so that over a range of angles C is largest, and least, at one end. Where float cannot tell the side,
// C hardly depends on the angle.
template <class F>
inline MaskOf<F> right_of_reference(F x, F y, int degree) {
  return power_of(x, degree) > power_of(y * (1 / static_cast<float>(degree - 1)), degree - 1);
}
