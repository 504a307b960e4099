// Sums over the sources of one level of a block. Part of block_kernels_<set>.cpp.

// At p, with derivatives along the unit vector e (tracing.md 3.1).
template <class F>
struct RaySums {
  F f, df;        // sum w d^-m and its derivative
  F g[3], dg[3];  // G = grad_S f and its derivative
  F second;       // sum w d^-(m+2) (M2)
  F third;        // at least sum m w tau d^-(m+3) (m M3)
};

struct Probe {
  Native px, py, pz, ex, ey, ez;
};

// As many sums, 12 or 16, over sources in lanes, one register of lanes after the other, so that accumulators stay in
// registers: add(group, nearest, a) adds the sources in the first of the lanes, and raises `nearest`.
template <int Count, class Add>
inline V16 sum_in_registers(const float* group, V16& nearest, const Add& add) {
  Native a[natives][Count], close[natives];
  split(nearest, close);
  for (int part = 0; part < natives; ++part) {
    Native of_part[Count];
#pragma GCC unroll 16
    for (int i = 0; i < Count; ++i) of_part[i] = Native{};
    add(group + part * native_lanes, close[part], of_part);
#pragma GCC unroll 16
    for (int i = 0; i < Count; ++i) a[part][i] = of_part[i];
  }
  nearest = joined(close);
  V16 whole[Count];
  for (int i = 0; i < Count; ++i) {
    Native parts[natives];
    for (int part = 0; part < natives; ++part) parts[part] = a[part][i];
    whole[i] = joined(parts);
  }
  return lane_sums(whole);
}

// The sums over one list, in lanes; what they stand for is told by add_list().
template <int Exponent>
inline V16 sum_list(const float* first_group, int groups, int exponent, const Probe& probe, V16& nearest) {
  return sum_in_registers<12>(first_group, nearest, [&](const float* group, Native& close, auto& a) {
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      const Native dx = probe.px - load_native(group), dy = probe.py - load_native(group + 16),
                   dz = probe.pz - load_native(group + 32);
      const Native share = load_native(group + 48), radius = load_native(group + 64);
      const Native inv = 1.0F / (dx * dx + dy * dy + dz * dz);
      const Native w0 = field_of<Exponent>(share, radius, inv, exponent);
      const Native w2 = w0 * inv, k2 = w2 * radius, k4 = k2 * inv;
      const Native along = dx * probe.ex + dy * probe.ey + dz * probe.ez, ka = k4 * along;
      a[0] += w0;
      a[1] += w2 * along;
      a[2] += w2;
      a[3] += k2;
      a[4] += k4;
      a[5] += k2 * dx;
      a[6] += k2 * dy;
      a[7] += k2 * dz;
      a[8] += ka * dx;
      a[9] += ka * dy;
      a[10] += ka * dz;
      close = larger(close, inv);
    }
  });
}

// Adds the sums of a list of exponent m; e is the direction of the ray.
template <class F>
inline void add_list(float m, const F (&s)[16], const F (&e)[3], RaySums<F>& out) {
  out.f += s[0];
  out.df -= m * s[1];
  out.second += s[2];
  out.third += m * root_of(s[3] * s[4]);  // Cauchy-Schwarz: M3^2 <= K2 K4
  for (int i = 0; i < 3; ++i) {
    out.g[i] -= m * s[5 + i];
    out.dg[i] += m * (m + 2) * s[8 + i] - m * e[i] * s[3];
  }
}

// f, grad f, G and the derivative of G in all directions (xx yy zz xy xz yz); second and third as in RaySums.
struct FullSums {
  float f, df[3], g[3], h[6], second, third;
};

template <int Exponent>
inline void add_full_sums(const float* first_group, int groups, int exponent, const float p[3], V16& nearest,
                          FullSums& out) {
  const V16 sums = sum_in_registers<16>(first_group, nearest, [&](const float* group, Native& close, auto& a) {
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      const Native dx = p[0] - load_native(group), dy = p[1] - load_native(group + 16),
                   dz = p[2] - load_native(group + 32);
      const Native inv = 1.0F / (dx * dx + dy * dy + dz * dz), radius = load_native(group + 64);
      const Native w0 = field_of<Exponent>(load_native(group + 48), radius, inv, exponent);
      const Native w2 = w0 * inv, k2 = w2 * radius, k4 = k2 * inv;
      const Native kx = k4 * dx, ky = k4 * dy, kz = k4 * dz;
      a[0] += w0;
      a[1] += w2 * dx;
      a[2] += w2 * dy;
      a[3] += w2 * dz;
      a[4] += k2;
      a[5] += k2 * dx;
      a[6] += k2 * dy;
      a[7] += k2 * dz;
      a[8] += w2;
      a[9] += k4;
      a[10] += kx * dx;
      a[11] += ky * dy;
      a[12] += kz * dz;
      a[13] += kx * dy;
      a[14] += kx * dz;
      a[15] += ky * dz;
      close = larger(close, inv);
    }
  });
  float s[16];
  __builtin_memcpy(s, &sums, sizeof s);
  const float m = static_cast<float>(Exponent > 0 ? Exponent : exponent);
  out.f += s[0];
  out.second += s[8];
  out.third += m * root_of(s[4] * s[9]);
  for (int i = 0; i < 3; ++i) {
    out.df[i] -= m * s[1 + i];
    out.g[i] -= m * s[5 + i];
    out.h[i] += m * (m + 2) * s[10 + i] - m * s[4];
    out.h[3 + i] += m * (m + 2) * s[13 + i];
  }
}

// The field A of angle_field.h, its derivative along the ray, and its M2.
struct AngleSums {
  float value, slope, second;
};

template <int Exponent>
inline void add_angle_sums(const float* first_group, int groups, int exponent, const Probe& probe, AngleSums& out) {
  V16 none{};
  const V16 sums = sum_in_registers<12>(first_group, none, [&](const float* group, Native&, auto& a) {
    for (int k = 0; k < groups; ++k, group += floats_per_group) {
      const Native dx = probe.px - load_native(group), dy = probe.py - load_native(group + 16),
                   dz = probe.pz - load_native(group + 32);
      const Native inv = 1.0F / (dx * dx + dy * dy + dz * dz);
      const Native w0 = field_of<Exponent>(load_native(group + 48), load_native(group + 64), inv, exponent),
                   w2 = w0 * inv;
      a[0] += w0;
      a[1] += w2 * (dx * probe.ex + dy * probe.ey + dz * probe.ez);
      a[2] += w2;
    }
  });
  float s[16];
  __builtin_memcpy(s, &sums, sizeof s);
  out.value += s[0];
  out.slope -= static_cast<float>(Exponent > 0 ? Exponent : exponent) * s[1];
  out.second += s[2];
}

inline const float* point_sources(const FieldLevel& l) {
  return l.sources + static_cast<long>(l.curve_groups) * floats_per_group;
}

// Calls sums<Exponent>(groups, count, exponent) for the curves (exponent: the degree) and for the points (one less).
template <class Sums>
inline void for_each_list(const FieldLevel& l, int degree, const Sums& sums) {
  if (l.curve_groups > 0) switch (degree) {
      case 3:
        sums.template add<3>(l.sources, l.curve_groups, 3);
        break;
      case 4:
        sums.template add<4>(l.sources, l.curve_groups, 4);
        break;
      case 5:
        sums.template add<5>(l.sources, l.curve_groups, 5);
        break;
      default:
        sums.template add<0>(l.sources, l.curve_groups, degree);
    }
  if (l.point_groups > 0) switch (degree) {
      case 3:
        sums.template add<2>(point_sources(l), l.point_groups, 2);
        break;
      case 4:
        sums.template add<3>(point_sources(l), l.point_groups, 3);
        break;
      case 5:
        sums.template add<4>(point_sources(l), l.point_groups, 4);
        break;
      default:
        sums.template add<0>(point_sources(l), l.point_groups, degree - 1);
    }
}

// For one ray; `nearest` becomes the largest 1 / d^2.
struct RaySummer {
  const LocalRay& ray;
  const Probe probe;
  V16& nearest;
  RaySums<float>& out;
  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    const V16 sums = sum_list<Exponent>(group, groups, exponent, probe, nearest);
    float s[16];
    __builtin_memcpy(s, &sums, sizeof s);
    add_list(static_cast<float>(Exponent > 0 ? Exponent : exponent), s, ray.direction, out);
  }
};

// For a packet: each ray has its own sums over the sources, in the order of a single ray.
struct PacketSummer {
  const PacketFloat (&at)[3];
  const PacketRays& rays;
  unsigned active;
  PacketFloat& nearest;
  RaySums<PacketFloat>& out;

  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    V16 s[packet_lanes];
    for (unsigned left = ~active & all_lane_bits; left != 0; left &= left - 1) s[__builtin_ctz(left)] = V16{};
    for (unsigned left = active; left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      const Probe probe{Native{} + at[0][lane],
                        Native{} + at[1][lane],
                        Native{} + at[2][lane],
                        Native{} + rays.direction[0][lane],
                        Native{} + rays.direction[1][lane],
                        Native{} + rays.direction[2][lane]};
      V16 close{};
      const V16 sums = sum_list<Exponent>(group, groups, exponent, probe, close);
      s[lane] = with_largest_last(sums, close);
    }
    PacketFloat columns[lanes];
    find_columns(s, columns);
    add_list(static_cast<float>(Exponent > 0 ? Exponent : exponent), columns, rays.direction, out);
    nearest = larger(nearest, columns[lanes - 1]);
  }
};

struct AngleSummer {
  const Probe probe;
  AngleSums& out;
  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    add_angle_sums<Exponent>(group, groups, exponent, probe, out);
  }
};

struct FullSummer {
  const float* p;
  V16& nearest;
  FullSums& out;
  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    add_full_sums<Exponent>(group, groups, exponent, p, nearest, out);
  }
};
