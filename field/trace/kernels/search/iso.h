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
