// Reading the iso curve (iso_curve.h). Part of block_kernels_<set>.cpp.

template <class F>
struct CurveValue {
  F value, slope;
};

// Between two entries; before the first one the table goes on level, beyond the last straight.
template <class F>
struct CurvePlace {
  F at, from, fraction;
  IntOf<F> index;
  float last;  // entry

  CurvePlace(const IsoCurve::View& iso, F u)
      : at((u - iso.u_begin) * iso.inverse_step), from(max_of(at, 0.0F)), last(static_cast<float>(iso.size - 1)) {
    index = whole_part(min_of(from, last - 0.5F));
    fraction = from - to_float(index);
  }
  CurveValue<F> in(const float* table) const {
    const auto [low, high] = neighbours_at(table, index);
    const F difference = high - low;
    return {low + difference * fraction, difference};
  }
  // As in(), and level beyond the last entry.
  F within(const float* table) const {
    const auto [low, high] = neighbours_at(table, index);
    return low + (high - low) * min_of(fraction, 1.0F);
  }
};

template <class F>
inline CurveValue<F> curve_at(const IsoCurve::View& iso, F u) {
  const CurvePlace<F> place(iso, u);
  const CurveValue<F> here = place.in(iso.value);
  return {here.value, select(place.at > 0.0F, here.slope * iso.inverse_step, F{})};
}

template <class F>
inline F lower_curve_at(const IsoCurve::View& iso, F u) {
  const CurvePlace<F> place(iso, u);
  return select(place.at >= place.last, all_lanes<F>(iso.lower_beyond), place.in(iso.lower).value);
}

template <class F>
inline F turned_u(const IsoCurve::View& iso, F x, F y) {
  return y * iso.sin_theta - x * iso.cos_theta;
}
template <class F>
inline F turned_v(const IsoCurve::View& iso, F x, F y) {
  return x * iso.sin_theta + y * iso.cos_theta;
}

// Positive only where the field is certainly below 1.
template <class F>
inline F margin_at(const IsoCurve::View& iso, F x, F y) {
  return lower_curve_at(iso, turned_u(iso, x, y)) - turned_v(iso, x, y);
}

// The same to within rounding: by the curve itself.
template <class F>
inline F nominal_margin_at(const IsoCurve::View& iso, F x, F y) {
  const CurvePlace<F> place(iso, turned_u(iso, x, y));
  const MaskOf<F> known = (place.at < place.last) | (all_lanes<F>(iso.lower_beyond) > -infinity);
  return select(known, place.in(iso.value).value - turned_v(iso, x, y), all_lanes<F>(-infinity));
}

// Whether the field is above 1, by the curve itself, and beyond the end of the table by its straight continuation: the
// table ends where the curve meets the axis x = 0, falling, and goes on along it, so that all beyond is inside and
// above that line.
template <class F>
inline MaskOf<F> nominally_inside(const IsoCurve::View& iso, F x, F y) {
  return (x > iso.critical) | (curve_at(iso, turned_u(iso, x, y)).value < turned_v(iso, x, y));
}

// Tables for several angles: all that they give is cubic in the share of the range, through the four tables around it.
struct IsoRows {
  const IsoCurve::View* first;
  float weight[4], slope[4];  // of the tables, and their derivatives by the share

  IsoRows(const BlockView& block, float share) {
    const float steps = static_cast<float>(block.row_count - 1), at = min_of(1, max_of(0, share)) * steps;
    int k = static_cast<int>(at) - 1;
    if (k > block.row_count - 4) k = block.row_count - 4;
    if (k < 0) k = 0;
    first = block.rows + k;
    // Lagrange's polynomials for nodes at 0, 1, 2, 3
    const float a = at - static_cast<float>(k), b = a - 1, c = a - 2, d = a - 3;
    const float w[4] = {b * c * d * (-1.0F / 6), a * c * d * 0.5F, a * b * d * -0.5F, a * b * c * (1.0F / 6)};
    const float s[4] = {(c * d + b * d + b * c) * (-1.0F / 6), (c * d + a * d + a * c) * 0.5F,
                        (b * d + a * d + a * b) * -0.5F, (b * c + a * c + a * b) * (1.0F / 6)};
    for (int i = 0; i < 4; ++i) {
      weight[i] = w[i];
      slope[i] = s[i] * steps;
    }
  }
};

inline float margin_at(const BlockView& block, float x, float y, float share) {
  const IsoRows rows(block, share);
  float margin = 0;
  for (int i = 0; i < 4; ++i) {
    const IsoCurve::View& iso = rows.first[i];
    const float u = turned_u(iso, x, y), lower = lower_curve_at(iso, u);
    if (!(lower > -infinity)) return -infinity;
    const float value = curve_at(iso, u).value;
    margin += rows.weight[i] * (value - turned_v(iso, x, y)) - abs_of(rows.weight[i]) * (value - lower);
  }
  return margin;
}

inline float nominal_margin_at(const BlockView& block, float x, float y, float share) {
  const IsoRows rows(block, share);
  float margin = 0;
  for (int i = 0; i < 4; ++i) {
    const float at_row = nominal_margin_at(rows.first[i], x, y);
    if (!(at_row > -infinity)) return -infinity;
    margin += rows.weight[i] * at_row;
  }
  return margin;
}

// Of an end of the range, where a table stands.
inline const IsoCurve::View& table_of_end(const BlockView& block, bool upper) {
  return block.rows[upper ? block.row_count - 1 : 0];
}

inline bool nominally_inside(const BlockView& block, float x, float y, float share) {
  if (x > block.iso.critical) return true;  // the first table is that of the least angle, which has the largest one
  const IsoRows rows(block, share);
  float margin = 0;
  for (int i = 0; i < 4; ++i) {
    const IsoCurve::View& iso = rows.first[i];
    margin += rows.weight[i] * (curve_at(iso, turned_u(iso, x, y)).value - turned_v(iso, x, y));
  }
  return margin < 0;
}

// At x and y, with derivatives along a ray. `share_slope` is that of the share.
struct IsoValue {
  float curve = 0, v = 0, slope = 0, v_slope = 0, x_weight = 0, y_weight = 0;
  float share_weight = 0;  // derivative of the residual by the share

  // Of one table.
  IsoValue(const IsoCurve::View& iso, float x, float y, float dx, float dy) {
    const CurveValue<float> at = curve_at(iso, turned_u(iso, x, y));
    curve = at.value;
    v = turned_v(iso, x, y);
    x_weight = iso.sin_theta + at.slope * iso.cos_theta;
    y_weight = iso.cos_theta - at.slope * iso.sin_theta;
    slope = -x_weight * dx - y_weight * dy;
    v_slope = turned_v(iso, dx, dy);
  }

  IsoValue(const BlockView& block, float share, float share_slope, float x, float y, float dx, float dy) {
    const IsoRows rows(block, share);
    for (int i = 0; i < 4; ++i) {
      const IsoCurve::View& iso = rows.first[i];
      const CurveValue<float> value = curve_at(iso, turned_u(iso, x, y));
      const float w = rows.weight[i], ws = rows.slope[i] * share_slope, here = turned_v(iso, x, y);
      curve += w * value.value;
      v += w * here;
      x_weight += w * (iso.sin_theta + value.slope * iso.cos_theta);
      y_weight += w * (iso.cos_theta - value.slope * iso.sin_theta);
      share_weight += rows.slope[i] * (value.value - here);
      v_slope += w * turned_v(iso, dx, dy) + ws * here;
    }
    slope = share_weight * share_slope - x_weight * dx - y_weight * dy;
  }
};
