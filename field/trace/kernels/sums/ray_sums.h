// Sums over sources for a place on a ray. Part of block_kernels_<set>.cpp.

// At p, with derivatives along the unit vector e (M2, M3: taylor_remainder.h).
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
  Native place[3], direction[3];
};

// The sums of RaySums along e, for add_list().
template <int Exponent>
struct SumsAlong {
  static constexpr int count = 11;
  struct Ready : FieldReady {
    Native along;
  };

  const Native (&e)[3];
  int exponent;

  Ready ready(Native share, Native radius, const Away& d) const {
    return {{d, field_of<Exponent>(share, radius, d.inverse, exponent)}, d.x * e[0] + d.y * e[1] + d.z * e[2]};
  }
  template <class Into>
  void add(const Ready& s, Native radius, const Into& into) const {
    const auto [w2, k2, k4] = Terms(s, radius);
    into(0, s.field);
    into(1, w2 * s.along);
    into(2, w2);
    into(3, k2);
    into(5, k2 * s.x);
    into(6, k2 * s.y);
    into(7, k2 * s.z);
    into(4, k4);
    const Native ka = k4 * s.along;
    into(8, ka * s.x);
    into(9, ka * s.y);
    into(10, ka * s.z);
  }
};

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
    const V16 sums = sum_groups(group, groups, probe.place, SumsAlong<Exponent>{probe.direction, exponent}, nearest);
    float s[16];
    __builtin_memcpy(s, &sums, sizeof s);
    add_list(static_cast<float>(Exponent > 0 ? Exponent : exponent), s, ray.direction, out);
  }
};
