// Sums over the sources of the field of angles for a place on a ray. Part of block_kernels_<set>.cpp.

// The field A of angle_field.h, its derivative along the ray, and its M2.
struct AngleSums {
  float value, slope, second;
};

template <int Exponent>
struct SumsOfAngles {
  static constexpr int count = 3;
  using Ready = typename SumsAlong<Exponent>::Ready;

  const Native (&e)[3];
  int exponent;

  Ready ready(Native share, Native radius, const Away& d) const {
    return SumsAlong<Exponent>{e, exponent}.ready(share, radius, d);
  }
  template <class Into>
  void add(const Ready& s, Native radius, const Into& into) const {
    const Terms of(s, radius);
    into(0, s.field);
    into(1, of.w2 * s.along);
    into(2, of.w2);
  }
};

template <int Exponent>
inline void add_angle_sums(const float* group, int groups, int exponent, const Probe& probe, AngleSums& out) {
  V16 unused{};
  const V16 sums = sum_groups(group, groups, probe.place, SumsOfAngles<Exponent>{probe.direction, exponent}, unused);
  float s[16];
  __builtin_memcpy(s, &sums, sizeof s);
  out.value += s[0];
  out.slope -= static_cast<float>(Exponent > 0 ? Exponent : exponent) * s[1];
  out.second += s[2];
}

struct AngleSummer {
  const Probe probe;
  AngleSums& out;
  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    add_angle_sums<Exponent>(group, groups, exponent, probe, out);
  }
};
