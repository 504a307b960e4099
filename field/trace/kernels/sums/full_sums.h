// Sums over sources for a place, with derivatives in all directions. Part of block_kernels_<set>.cpp.

// f, grad f, G and the derivative of G in all directions (xx yy zz xy xz yz); second and third as in RaySums.
template <class F>
struct FullSums {
  F f{}, df[3]{}, g[3]{}, h[6]{}, second{}, third{};
};

// The sums that add_full_list() reads.
template <int Exponent>
struct SumsAllAround {
  static constexpr int count = 16;
  using Ready = FieldReady;

  int exponent;

  Ready ready(Native share, Native radius, const Away& d) const {
    return {d, field_of<Exponent>(share, radius, d.inverse, exponent)};
  }
  template <class Into>
  void add(const Ready& s, Native radius, const Into& into) const {
    const auto [w2, k2, k4] = Terms(s, radius);
    const Native kx = k4 * s.x, ky = k4 * s.y, kz = k4 * s.z;
    into(0, s.field);
    into(1, w2 * s.x);
    into(2, w2 * s.y);
    into(3, w2 * s.z);
    into(4, k2);
    into(5, k2 * s.x);
    into(6, k2 * s.y);
    into(7, k2 * s.z);
    into(8, w2);
    into(9, k4);
    into(10, kx * s.x);
    into(11, ky * s.y);
    into(12, kz * s.z);
    into(13, kx * s.y);
    into(14, kx * s.z);
    into(15, ky * s.z);
  }
};

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

struct FullSummer {
  const float* p;
  V16& nearest;
  FullSums<float>& out;
  template <int Exponent>
  void add(const float* group, int groups, int exponent) const {
    const Native place[3] = {p[0] - Native{}, p[1] - Native{}, p[2] - Native{}};
    const V16 sums = sum_groups(group, groups, place, SumsAllAround<Exponent>{exponent}, nearest);
    float s[16];
    __builtin_memcpy(s, &sums, sizeof s);
    add_full_list(static_cast<float>(Exponent > 0 ? Exponent : exponent), s, out);
  }
};
