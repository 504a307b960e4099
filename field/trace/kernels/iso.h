// Reading the iso curve (iso_curve.h). Part of block_kernels_<set>.cpp.

struct CurveValue {
  float value, slope;
};

inline CurveValue curve_at(const IsoCurve::View& iso, float u) {
  const float at = (u - iso.u_begin) * iso.inverse_step;
  if (!(at > 0)) return {iso.value[0], 0};
  int i = iso.size - 2;
  if (at < static_cast<float>(iso.size - 1)) i = static_cast<int>(at);
  const float difference = iso.value[i + 1] - iso.value[i];
  return {iso.value[i] + difference * (at - static_cast<float>(i)), difference * iso.inverse_step};
}

inline float lower_curve_at(const IsoCurve::View& iso, float u) {
  const float at = (u - iso.u_begin) * iso.inverse_step;
  if (!(at > 0)) return iso.lower[0];
  if (!(at < static_cast<float>(iso.size - 1))) return -infinity;
  const int i = static_cast<int>(at);
  return iso.lower[i] + (iso.lower[i + 1] - iso.lower[i]) * (at - static_cast<float>(i));
}

inline float turned_u(const IsoCurve::View& iso, float x, float y) { return y * iso.sin_theta - x * iso.cos_theta; }
inline float turned_v(const IsoCurve::View& iso, float x, float y) { return x * iso.sin_theta + y * iso.cos_theta; }

// Positive only where the field is certainly below 1.
inline float margin_at(const IsoCurve::View& iso, float x, float y) {
  return lower_curve_at(iso, turned_u(iso, x, y)) - turned_v(iso, x, y);
}

// The same to within rounding: by the curve itself.
inline float nominal_margin_at(const IsoCurve::View& iso, float x, float y) {
  const float u = turned_u(iso, x, y);
  if (!((u - iso.u_begin) * iso.inverse_step < static_cast<float>(iso.size - 1))) return -infinity;
  return curve_at(iso, u).value - turned_v(iso, x, y);
}

// Whether the field is above 1, by the curve itself; false where the table ends.
inline bool nominally_inside(const IsoCurve::View& iso, float x, float y) {
  const float u = turned_u(iso, x, y);
  if (!((u - iso.u_begin) * iso.inverse_step < static_cast<float>(iso.size - 1))) return false;
  return x > iso.critical || curve_at(iso, u).value < turned_v(iso, x, y);
}

// margin_at() for 16 points at once.
using Index16 = int __attribute__((vector_size(64)));

struct CurvePlace {
  Index16 index;
  V16 fraction;
  Index16 beyond;  // the end of the table

  CurvePlace(const IsoCurve::View& iso, V16 u) {
    const V16 at = (u - iso.u_begin) * iso.inverse_step, from = at > 0.0F ? at : V16{};
    const float last = static_cast<float>(iso.size - 1);
    beyond = ~(at < last);
    index = __builtin_convertvector(from < last - 0.5F ? from : splat(last - 0.5F), Index16);
    fraction = from - __builtin_convertvector(index, V16);
  }
  V16 between(const float* table) const {
    V16 low, high;
    for (int i = 0; i < lanes; ++i) {
      low[i] = table[index[i]];
      high[i] = table[index[i] + 1];
    }
    return low + (high - low) * fraction;
  }
};

inline V16 turned_u(const IsoCurve::View& iso, V16 x, V16 y) { return y * iso.sin_theta - x * iso.cos_theta; }
inline V16 turned_v(const IsoCurve::View& iso, V16 x, V16 y) { return x * iso.sin_theta + y * iso.cos_theta; }

inline V16 margin_at(const IsoCurve::View& iso, V16 x, V16 y) {
  const CurvePlace place(iso, turned_u(iso, x, y));
  const V16 lower = place.between(iso.lower);
  return (place.beyond ? splat(-infinity) : lower) - turned_v(iso, x, y);
}

inline V16 nominal_at(const IsoCurve::View& iso, V16 x, V16 y) {
  return CurvePlace(iso, turned_u(iso, x, y)).between(iso.value) - turned_v(iso, x, y);
}
