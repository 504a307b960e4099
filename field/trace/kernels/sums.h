// Sums over the sources of one level of a block. Part of block_kernels_<set>.cpp.

// At p, with derivatives along the unit vector e (tracing.md 3.1).
template <class F>
struct RaySums {
  F f, df;        // sum w d^-m and its derivative
  F g[3], dg[3];  // G = grad_S f and its derivative
  F second;       // sum w d^-(m+2) (M2)
  F third;        // at least sum m w tau d^-(m+3) (m M3)
};

inline void assign(PacketMask mask, RaySums<PacketFloat>& to, const RaySums<PacketFloat>& from) {
  using Sums = RaySums<PacketFloat>;
  for (PacketFloat Sums::*part : {&Sums::f, &Sums::df, &Sums::second, &Sums::third}) assign(mask, to.*part, from.*part);
  for (int i = 0; i < 3; ++i) {
    assign(mask, to.g[i], from.g[i]);
    assign(mask, to.dg[i], from.dg[i]);
  }
}

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

// Lane by lane, from a source to a place.
struct Away {
  Native x, y, z, inverse;  // and 1 / d^2

  Away(Native dx, Native dy, Native dz) : x(dx), y(dy), z(dz) { inverse = 1.0F / (x * x + y * y + z * z); }
};

// add(at, away) for `count` sources or groups of them, `stride` floats apart, with away(at). The division for the next
// one is under way while one is added: processors do not look as far ahead by themselves.
template <class AwayOf, class Add>
inline void for_each_source(const float* at, int count, int stride, const AwayOf& away, const Add& add) {
  if (count == 0) return;
  Away here = away(at);
  for (int k = 1; k < count; ++k, at += stride) {
    const Away next = away(at + stride);
    add(at, here);
    here = next;
  }
  add(at, here);
}

// What sources of this share and radius have there: w d^-m and w d^-(m+2), w tau d^-(m+2) and w tau d^-(m+4).
template <int Exponent>
struct Terms {
  Native w0, w2, k2, k4;

  Terms(Native share, Native radius, int exponent, const Away& d)
      : w0(field_of<Exponent>(share, radius, d.inverse, exponent)),
        w2(w0 * d.inverse),
        k2(w2 * radius),
        k4(k2 * d.inverse) {}
};

// Adds them to the twelve sums of RaySums along e; the last is their largest 1 / d^2.
template <int Exponent>
inline void add_sources(Native share, Native radius, int exponent, const Away& d, Native ex, Native ey, Native ez,
                        Native (&a)[12]) {
  const auto [w0, w2, k2, k4] = Terms<Exponent>(share, radius, exponent, d);
  const Native along = d.x * ex + d.y * ey + d.z * ez, ka = k4 * along;
  a[0] += w0;
  a[1] += w2 * along;
  a[2] += w2;
  a[3] += k2;
  a[4] += k4;
  a[5] += k2 * d.x;
  a[6] += k2 * d.y;
  a[7] += k2 * d.z;
  a[8] += ka * d.x;
  a[9] += ka * d.y;
  a[10] += ka * d.z;
  a[11] = larger(a[11], d.inverse);
}

// for_each_source() of groups, sources in lanes: add(share, radius, away). The place: floats, or the same in all lanes.
template <class Place, class Add>
inline void for_each_group(const float* first, int groups, Place px, Place py, Place pz, const Add& add) {
  const auto away = [&](const float* group) {
    return Away(px - load_native(group), py - load_native(group + 16), pz - load_native(group + 32));
  };
  for_each_source(first, groups, floats_per_group, away,
                  [&](const float* group, const Away& d) { add(load_native(group + 48), load_native(group + 64), d); });
}

// The sums over one list for one ray; what they stand for is told by add_list().
template <int Exponent>
inline V16 sum_list(const float* first_group, int groups, int exponent, const Probe& probe, V16& nearest) {
  return sum_in_registers<12>(first_group, nearest, [&](const float* first, Native& close, auto& a) {
    for_each_group(first, groups, probe.px, probe.py, probe.pz, [&](Native share, Native radius, const Away& d) {
      add_sources<Exponent>(share, radius, exponent, d, probe.ex, probe.ey, probe.ez, a);
    });
    close = larger(close, a[11]);
    a[11] = Native{};
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
template <class F>
struct FullSums {
  F f{}, df[3]{}, g[3]{}, h[6]{}, second{}, third{};
};

// Adds sources to the sixteen sums that add_full_list() reads.
template <int Exponent>
inline void add_to_full(Native share, Native radius, int exponent, const Away& d, Native* a) {
  const auto [w0, w2, k2, k4] = Terms<Exponent>(share, radius, exponent, d);
  const Native kx = k4 * d.x, ky = k4 * d.y, kz = k4 * d.z;
  a[0] += w0;
  a[1] += w2 * d.x;
  a[2] += w2 * d.y;
  a[3] += w2 * d.z;
  a[4] += k2;
  a[5] += k2 * d.x;
  a[6] += k2 * d.y;
  a[7] += k2 * d.z;
  a[8] += w2;
  a[9] += k4;
  a[10] += kx * d.x;
  a[11] += ky * d.y;
  a[12] += kz * d.z;
  a[13] += kx * d.y;
  a[14] += kx * d.z;
  a[15] += ky * d.z;
}

// Adds the sums of a list of exponent m.
template <class F>
inline void add_full_list(float m, const F* s, FullSums<F>& out) {
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

inline const float* point_sources(const FieldLevel& l) {
  return l.sources + static_cast<long>(l.curve_groups) * floats_per_group;
}

// An exponent that is known to the compiler; 0: only at run time.
template <int Exponent>
struct Known {
  static constexpr int exponent = Exponent;
};

template <class Add>
inline void with_exponent(int exponent, const Add& add) {
  switch (exponent) {
    case 2:
      return add(Known<2>{});
    case 3:
      return add(Known<3>{});
    case 4:
      return add(Known<4>{});
    case 5:
      return add(Known<5>{});
    default:
      add(Known<0>{});
  }
}

// The sources of one exponent.
struct SourceList {
  const float* groups;
  int count;
};
inline SourceList curves_of(const FieldLevel& l) { return {l.sources, l.curve_groups}; }
inline SourceList points_of(const FieldLevel& l) { return {point_sources(l), l.point_groups}; }

// Calls sums.add<Exponent>(groups, count, exponent) for the curves (exponent: the degree) and for the points (one
// less).
template <class Sums>
inline void for_each_list(const FieldLevel& l, int degree, const Sums& sums) {
  const auto add = [&](const SourceList& list, int exponent) {
    if (list.count == 0) return;
    with_exponent(exponent,
                  [&](auto known) { sums.template add<decltype(known)::exponent>(list.groups, list.count, exponent); });
  };
  add(curves_of(l), degree);
  add(points_of(l), degree - 1);
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
  FullSums<float>& out;
  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    const V16 sums = sum_in_registers<16>(group, nearest, [&](const float* first, Native& close, auto& a) {
      for_each_group(first, groups, p[0], p[1], p[2], [&](Native share, Native radius, const Away& d) {
        add_to_full<Exponent>(share, radius, exponent, d, a);
        close = larger(close, d.inverse);
      });
    });
    float s[16];
    __builtin_memcpy(s, &sums, sizeof s);
    add_full_list(static_cast<float>(Exponent > 0 ? Exponent : exponent), s, out);
  }
};
