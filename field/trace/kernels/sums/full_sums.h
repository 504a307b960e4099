// Sums over sources for a place, with derivatives in all directions. Part of block_kernels_<set>.cpp.

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
