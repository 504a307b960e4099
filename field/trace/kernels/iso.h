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
