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

  PatchRay(const BlockView& b, const PatchNode& node, int octant, const LocalRay& local, float t0, float t1)
      : block(b),
        f_error(node.f_error[octant]),
        g_error(node.g_error[octant]),
        ray({.far = b.polynomials + static_cast<long>(node.polynomial[octant]) * far_floats},
            in_octant(local, node, octant), t0, t1) {}

  static LocalRay in_octant(const LocalRay& local, const PatchNode& node, int octant) {
    LocalRay r;
    const float scale = 2 / node.half;
    for (int k = 0; k < 3; ++k) {
      r.origin[k] = scale * (local.origin[k] - node.center[k]) + (octant >> k & 1 ? -1.0F : 1.0F);
      r.direction[k] = scale * local.direction[k];
    }
    return r;
  }
  float t_of(float s) const { return ray.middle + s / ray.inverse_half; }

  // The first run in [from, to]: 15 intervals, over each of which f and |G| are at most the larger of their values at
  // its ends plus what second derivatives allow (convexity bounds |G| of the chord).
  Run scan(float from, float to) const {
    const float width = (to - from) * (1.0F / last);
    Samples at(*this, from, width);
    const float bend = 0.25F * width * width;
    // The curvatures are per unit t; s is t over the half length.
    const float half2 = 1 / (ray.inverse_half * ray.inverse_half);
    const float x_raise = bend * ray.f_curvature * half2 + f_error, y_raise = bend * ray.g_curvature * half2 + g_error;
    Run run;
    int first = 0;
    while (first < last && at.outside(block.iso, first, x_raise, y_raise)) ++first;
    if (first == last) return run;
    int stop = first + 1;
    while (stop < last && !at.outside(block.iso, stop, x_raise, y_raise)) ++stop;
    run.found = true;
    run.begin = first == 0 ? from : from + width * static_cast<float>(first);
    run.end = stop == last ? to : from + width * static_cast<float>(stop);
    locate(at, first, stop, from, width, run);
    return run;
  }

 private:
  struct Samples {
    alignas(64) float x[lanes], y[lanes];

    Samples(const PatchRay& p, float from, float width) {
      V16 s;
      for (int i = 0; i < lanes; ++i) s[i] = static_cast<float>(i);
      s = from + width * s;
      const V4(&c)[5] = p.ray.c;
      V16 v[4];
      for (int k = 0; k < 4; ++k) v[k] = c[0][k] + s * (c[1][k] + s * (c[2][k] + s * (c[3][k] + s * c[4][k])));
      const V16 length = root_of(v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
      __builtin_memcpy(x, &v[0], sizeof x);
      __builtin_memcpy(y, &length, sizeof y);
    }
    bool outside(const IsoCurve::View& iso, int i, float x_raise, float y_raise) const {
      const float x_up = (max_of(x[i], x[i + 1]) + x_raise) * (1 + rounding);
      const float y_up = (max_of(y[i], y[i + 1]) + y_raise) * (1 + rounding);
      if (!(margin_at(iso, x_up, y_up) > 0)) return false;
      return !iso.two_sided || margin_at(iso, max_of(0, min_of(x[i], x[i + 1]) - x_raise), y_up) > 0;
    }
  };

  static float nominal(const IsoCurve::View& iso, float x, float y) {
    return curve_at(iso, turned_u(iso, x, y)).value - turned_v(iso, x, y);
  }

  bool surely_inside(float x, float y) const {
    if (block.iso.two_sided) return false;
    const float x_low = (x - f_error) * (1 - rounding), y_low = (y - g_error) * (1 - rounding);
    return x_low > 0 && y_low > 0 && nominal(block.iso, x_low, y_low) < 0;
  }

  void locate(const Samples& at, int first, int stop, float from, float width, Run& run) const {
    float before = 0, least = infinity;
    for (int i = first; i <= stop; ++i) {
      const float r = nominal(block.iso, at.x[i], at.y[i]), s = from + width * static_cast<float>(i);
      if (r <= 0) {
        run.crosses = true;
        run.guess = i == first ? s : refined(s - width, before, s, r);
        break;
      }
      if (r < least) {
        least = r;
        run.guess = s;
      }
      before = r;
    }
    if (!run.crosses) return;
    for (int i = first; i <= stop; ++i)
      if (surely_inside(at.x[i], at.y[i])) {
        run.surely = true;
        run.inside = from + width * static_cast<float>(i);
        return;
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
