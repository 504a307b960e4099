// Sums over sources for a place on a ray. Part of block_kernels_<set>.cpp.

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

// Adds sources to the twelve sums of RaySums along e; the last is their largest 1 / d^2.
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
