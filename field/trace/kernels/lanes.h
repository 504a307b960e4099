// Vectors of 16 floats with sums in one fixed order. Part of block_kernels_<set>.cpp, inside its namespace.
// Lanes are sources in sums, and rays in packets.
// Only builtins and functions of these files are used: an inline function of a library, compiled here for a
// large instruction set, could be the copy that the linker keeps for everybody.

using V16 = float __attribute__((vector_size(64)));
using V4 = float __attribute__((vector_size(16)));
using Index16 = int __attribute__((vector_size(64)));

inline constexpr float infinity = __builtin_inff();
inline float max_of(float a, float b) { return a > b ? a : b; }
inline float min_of(float a, float b) { return a < b ? a : b; }
inline float abs_of(float a) { return __builtin_fabsf(a); }
inline float root_of(float a) { return __builtin_sqrtf(a); }

inline V16 splat(float s) { return V16{} + s; }

// a^k for k > 0, of a float or a V16.
template <class T>
inline T power_of(T a, int k) {
  for (; !(k & 1); k >>= 1) a = a * a;
  T power = a;
  while (k >>= 1) {
    a = a * a;
    if (k & 1) power = power * a;
  }
  return power;
}
inline V16 load(const float* p) { return *static_cast<const V16*>(__builtin_assume_aligned(p, 64)); }
inline V16 root_of(V16 v) {
  V16 r;
  for (int i = 0; i < lanes; ++i) r[i] = __builtin_sqrtf(v[i]);
  return r;
}

// inv^(m/2) = d^-m. Exponent 0 in the template means known only at run time.
template <int Exponent>
inline V16 inverse_power(V16 inv, int exponent) {
  const int m = Exponent > 0 ? Exponent : exponent;
  V16 power = (m & 1) ? root_of(inv) : splat(1);
  for (int k = m / 2; k > 0; --k) power = power * inv;
  return power;
}

// share (tau / d)^m: the weight share tau^m alone could overflow beside a far smaller source.
template <int Exponent>
inline V16 field_of(V16 share, V16 tau, V16 inv, int exponent) {
  return share * inverse_power<Exponent>(tau * tau * inv, exponent);
}

// Sums over 16 lanes of 12 or 16 accumulators at once, in as many lanes, as a tree: halves, quarters, pairs, single
// lanes.
template <int Count>
inline V16 lane_sums(const V16 (&a)[Count]) {
  static_assert(Count == 12 || Count == 16);
  constexpr int quads = Count / 4;
  V16 b[Count / 2], c[4] = {}, d[2];
  for (int i = 0; i < Count / 2; ++i)
    b[i] =
        __builtin_shufflevector(a[2 * i], a[2 * i + 1], 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23) +
        __builtin_shufflevector(a[2 * i], a[2 * i + 1], 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  for (int i = 0; i < quads; ++i)
    c[i] = __builtin_shufflevector(b[2 * i], b[2 * i + 1], 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27) +
           __builtin_shufflevector(b[2 * i], b[2 * i + 1], 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
  for (int i = 0; i < 2; ++i) {
    const V16 lo = c[2 * i], hi = c[2 * i + 1];
    d[i] = __builtin_shufflevector(lo, hi, 0, 1, 4, 5, 8, 9, 12, 13, 16, 17, 20, 21, 24, 25, 28, 29) +
           __builtin_shufflevector(lo, hi, 2, 3, 6, 7, 10, 11, 14, 15, 18, 19, 22, 23, 26, 27, 30, 31);
  }
  return __builtin_shufflevector(d[0], d[1], 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30) +
         __builtin_shufflevector(d[0], d[1], 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
}
template <int Count>
inline void sum_lanes(const V16 (&a)[Count], float (&sums)[16]) {
  const V16 s = lane_sums(a);
  __builtin_memcpy(sums, &s, sizeof s);
}

// a > b ? a : b and a < b ? a : b: what the instructions of all sets do, also where a lane is no number. Without
// AVX-512 the compiler takes such an expression of 16 lanes apart.
#if defined(__AVX512F__)
inline V16 larger(V16 a, V16 b) { return a > b ? a : b; }
inline V16 smaller(V16 a, V16 b) { return a < b ? a : b; }
#else
#if defined(__AVX__)
using Part = float __attribute__((vector_size(32)));
inline Part larger_part(Part a, Part b) { return __builtin_ia32_maxps256(a, b); }
inline Part smaller_part(Part a, Part b) { return __builtin_ia32_minps256(a, b); }
#else
using Part = V4;
inline Part larger_part(Part a, Part b) { return __builtin_ia32_maxps(a, b); }
inline Part smaller_part(Part a, Part b) { return __builtin_ia32_minps(a, b); }
#endif
template <class Operation>
inline V16 in_parts(V16 a, V16 b, const Operation& operation) {
  constexpr int count = sizeof(V16) / sizeof(Part);
  Part x[count], y[count];
  __builtin_memcpy(x, &a, sizeof a);
  __builtin_memcpy(y, &b, sizeof b);
  for (int i = 0; i < count; ++i) x[i] = operation(x[i], y[i]);
  __builtin_memcpy(&a, x, sizeof a);
  return a;
}
inline V16 larger(V16 a, V16 b) {
  return in_parts(a, b, [](Part x, Part y) { return larger_part(x, y); });
}
inline V16 smaller(V16 a, V16 b) {
  return in_parts(a, b, [](Part x, Part y) { return smaller_part(x, y); });
}
#endif

inline float largest_lane(V16 v) {
  v = larger(v, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
  const V4 low = __builtin_shufflevector(v, v, 0, 1, 2, 3), high = __builtin_shufflevector(v, v, 4, 5, 6, 7);
  const V4 m = low > high ? low : high, n = __builtin_shufflevector(m, m, 2, 3, 0, 1), k = m > n ? m : n;
  return max_of(k[0], k[1]);
}

// The last lane becomes the largest one of `v`.
inline V16 with_largest_last(V16 lanes_of, V16 v) {
  v = larger(v, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
  v = larger(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11));
  v = larger(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13));
  v = larger(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14));
  return __builtin_shufflevector(lanes_of, v, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 31);
}

inline V4 load4(const float* p) {
  V4 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
