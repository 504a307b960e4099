// What the polynomial of one patch says about a stretch of a ray. Part of block_kernels_<set>.cpp.

// The rays' polynomials in s = -1 .. 1, and scans of them.
struct PatchRay {
  static constexpr int last = lanes - 1;  // samples 0 .. last end the intervals of a scan

  const BlockView& block;
  float f_error, g_error;
  FarOnRay ray;

  // Surface, or what is inside it, may be in [begin, end] only; before begin there is none.
  struct Run {
    bool found = false;
    float begin = 0, end = 0;
    bool crosses = false;  // the polynomials reach 1, about at `guess`; else they come nearest to it there
    float guess = 0;
    bool surely = false;  // the exact field is above 1 at `inside`
    float inside = 0;
  };

  PatchRay(const BlockView& b, const Patch& patch, const LocalRay& local, float t0, float t1)
      : block(b),
        f_error(patch.f_error),
        g_error(patch.g_error),
        ray({.far = patch.polynomial}, in_patch(local, patch), t0, t1) {}

  static LocalRay in_patch(const LocalRay& local, const Patch& patch) {
    LocalRay r;
    const float scale = 1 / patch.half;
    for (int k = 0; k < 3; ++k) {
      r.origin[k] = scale * (local.origin[k] - patch.center[k]);
      r.direction[k] = scale * local.direction[k];
    }
    return r;
  }
  float t_of(float s) const { return ray.middle + s / ray.inverse_half; }

  // The first run in [from, to]: 15 intervals, over each of which f and |G| are at most the larger of their values at
  // its ends plus what second derivatives allow (convexity bounds |G| of the chord).
  Run scan(float from, float to) const {
    const float width = (to - from) * (1.0F / last);
    V16 x, y;
    sample(from, width, x, y);
    // The curvatures are per unit t; s is t over the half length.
    const float bend = 0.25F * width * width / (ray.inverse_half * ray.inverse_half);
    const float x_raise = bend * ray.f_curvature + f_error, y_raise = bend * ray.g_curvature + g_error;
    const V16 x_next = next(x), y_next = next(y);
    const V16 x_up = (larger(x, x_next) + x_raise) * (1 + rounding),
              y_up = (larger(y, y_next) + y_raise) * (1 + rounding);
    V16 margin = margin_at(block.iso, x_up, y_up);
    if (block.iso.two_sided) {
      const V16 x_low = larger(V16{}, (x < x_next ? x : x_next) - x_raise);
      const V16 other = margin_at(block.iso, x_low, y_up);
      margin = margin < other ? margin : other;
    }
    alignas(64) float sure[lanes];  // outside between this sample and the next, where positive
    __builtin_memcpy(sure, &margin, sizeof sure);
    Run run;
    int first = 0;
    while (first < last && sure[first] > 0) ++first;
    if (first == last) return run;
    int stop = first + 1;
    while (stop < last && !(sure[stop] > 0)) ++stop;
    run.found = true;
    run.begin = first == 0 ? from : from + width * static_cast<float>(first);
    run.end = stop == last ? to : from + width * static_cast<float>(stop);
    locate(x, y, first, stop, from, width, run);
    return run;
  }

 private:
  void sample(float from, float width, V16& x, V16& y) const {
    const V16 count{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const V16 s = from + width * count;
    const V4(&c)[5] = ray.c;
    V16 v[4];
    for (int k = 0; k < 4; ++k) v[k] = c[0][k] + s * (c[1][k] + s * (c[2][k] + s * (c[3][k] + s * c[4][k])));
    x = v[0];
    y = root_of(v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
  }
  static V16 next(V16 v) {
    return __builtin_shufflevector(v, v, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 15);
  }

  static float nominal(const IsoCurve::View& iso, float x, float y) {
    return curve_at(iso, turned_u(iso, x, y)).value - turned_v(iso, x, y);
  }

  // Where the polynomials first reach 1 among the samples of a run, and where the field surely does.
  void locate(V16 x, V16 y, int first, int stop, float from, float width, Run& run) const {
    alignas(64) float above[lanes], surely[lanes];
    const V16 here = nominal_at(block.iso, x, y);
    __builtin_memcpy(above, &here, sizeof above);
    int least = first;
    for (int i = first; i <= stop && above[least] > 0; ++i)
      if (above[i] < above[least] || above[i] <= 0) least = i;
    run.crosses = above[least] <= 0;
    run.guess = from + width * static_cast<float>(least);
    if (!run.crosses) return;
    if (least > first) run.guess = refined(run.guess - width, above[least - 1], run.guess, above[least]);
    if (block.iso.two_sided) return;
    const V16 x_low = (x - f_error) * (1 - rounding), y_low = (y - g_error) * (1 - rounding);
    const V16 deep = nominal_at(block.iso, x_low, y_low);
    const V16 proved = x_low > 0.0F ? (y_low > 0.0F ? deep : splat(1)) : splat(1);
    __builtin_memcpy(surely, &proved, sizeof surely);
    for (int i = first; i <= stop && !run.surely; ++i) {
      run.surely = surely[i] < 0;
      run.inside = from + width * static_cast<float>(i);
    }
  }

  // Regula falsi, and the parabola through its point.
  float refined(float a, float at_a, float b, float at_b) const {
    const float mid = a + (b - a) * (at_a / (at_a - at_b));
    V4 v = ray.c[0] + mid * (ray.c[1] + mid * (ray.c[2] + mid * (ray.c[3] + mid * ray.c[4])));
    const float r = nominal(block.iso, v[0], root_of(v[1] * v[1] + v[2] * v[2] + v[3] * v[3]));
    const float slope = (at_b - at_a) / (b - a), da = mid - a, db = b - mid;
    // Divided differences: slope at mid of the parabola through the three points.
    const float curve = da > 0 && db > 0 ? ((at_b - r) / db - (r - at_a) / da) / (b - a) : 0;
    const float slope_mid = da > 0 ? (r - at_a) / da + curve * da : slope;
    return slope_mid < 0 ? min_of(b, max_of(a, mid - r / slope_mid)) : mid;
  }
};
