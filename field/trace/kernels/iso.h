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

// Whether the field is above 1, by the curve itself, and beyond the end of the table by its straight continuation: the
// table ends where the curve meets the axis x = 0, falling, so that all beyond is inside and above that line.
inline bool nominally_inside(const IsoCurve::View& iso, float x, float y) {
  return x > iso.critical || curve_at(iso, turned_u(iso, x, y)).value < turned_v(iso, x, y);
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
    const CurveValue at = curve_at(iso, turned_u(iso, x, y));
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
      const CurveValue value = curve_at(iso, turned_u(iso, x, y));
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
