// Sums over the sources of the field of angles for a place on a ray. Part of block_kernels_<set>.cpp.

// The field A of angle_field.h, its derivative along the ray, and its M2.
struct AngleSums {
  float value, slope, second;
};

template <int Exponent>
inline void add_angle_sums(const float* first_group, int groups, int exponent, const Probe& probe, AngleSums& out) {
  V16 none{};
  const V16 sums = sum_in_registers<12>(first_group, none, [&](const float* first, Native&, auto& a) {
    for_each_group(first, groups, probe.px, probe.py, probe.pz, [&](Native share, Native radius, const Away& d) {
      const Terms<Exponent> of(share, radius, exponent, d);
      a[0] += of.w0;
      a[1] += of.w2 * (d.x * probe.ex + d.y * probe.ey + d.z * probe.ez);
      a[2] += of.w2;
    });
  });
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
